// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "format/body.hpp"
#include "mesher/geometry/surface.hpp"
#include "mesher/geometry/text.hpp"

namespace palpate::mesher {

/// Vertices on the walls of cavities, which no tool reaches, are no sites; the log counts them. A
/// cavity is a closed part of the response surface that encloses a negative volume.
/// @param boundary its first points are the response vertices
void exclude_cavities(Body& body, const Surface& boundary, const Log& log);

}  // namespace palpate::mesher
