// SPDX-License-Identifier: AGPL-3.0-or-later
// Faces of zero area and faces that cross others.
#pragma once

#include "mesher/geometry/surface.hpp"
#include "mesher/repair/points.hpp"

namespace palpate::mesher {

/// @pre the surface is manifold
void remove_degenerate_faces(Surface& surface, Steps& steps);

/// Removes local self-intersections: the faces around them are removed and the holes filled. A
/// surface with many of them is left as it is: it would take long and change much.
/// @pre the surface is manifold
/// @returns whether none is left; if not, the surface is as it was
bool remove_crossings(Surface& surface, Steps& steps);

}  // namespace palpate::mesher
