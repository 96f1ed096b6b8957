// SPDX-License-Identifier: AGPL-3.0-or-later
// The tetrahedra of a body together with the two triangulations of its surface.
#pragma once

#include <string>

#include "mesher/skin/remesh.hpp"
#include "mesher/volume/volume_mesh.hpp"

namespace palpate::mesher {

struct Discretization {
  NestedSurface skin;  ///< the points of its boundary are the first nodes of the volume
  VolumeMesh volume;
};

/// The boundary facets of the tetrahedra, oriented outward; indices are those of the nodes.
/// @throws Error(Geometry) with the place where an edge has more than two facets, or where the
///   surface touches itself in a node.
std::vector<Triangle> boundary_of(const VolumeMesh& volume, const std::string& where);

/// Coarsens the boundary of the tetrahedra to a response surface with edges near `spacing` (m) and
/// orders the nodes: response vertices, other nodes of the boundary, interior nodes. With a spacing
/// of 0 every node of the boundary is a response vertex.
/// @throws Error(Geometry) as boundary_of.
Discretization with_response(VolumeMesh volume, double spacing, double feature_angle,
                             const std::string& where);

}  // namespace palpate::mesher
