// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "mesher/geometry/soup.hpp"

namespace palpate::mesher {

/// Whether the faces bound one volume: manifold, closed, consistently oriented or to be oriented,
/// in one part, without triangles of zero area and without self-intersections.
bool is_sound(const Soup& soup);

}  // namespace palpate::mesher
