// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <map>

#include "format/vec3.hpp"
#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

/// Puts a point on some edges of a surface, and divides the triangles between these points: where
/// two edges of a triangle have one, an edge joins them, and where one has, an edge leads to the
/// corner opposite to it. The points join the end of the surface in the order of their edges, and
/// the parts of a triangle have its name.
void split_edges(Surface& surface, const std::map<Edge, Vec3>& points);

}  // namespace palpate::mesher
