// SPDX-License-Identifier: AGPL-3.0-or-later
// A curved skin on elements with flat sides.
#pragma once

#include "format/body.hpp"

namespace palpate::mesher {

/// Halves the bulge of the curved edges of every element of which a part would turn over, or shrink
/// to less than a third, when the element is divided at the middles of some of its edges.
/// @return how many edges bulge less than before.
std::size_t draw_back_edges(Body& body);

}  // namespace palpate::mesher
