// SPDX-License-Identifier: AGPL-3.0-or-later
// The facets between the regions of a volume mesh and around it.
#pragma once

#include <optional>
#include <vector>

#include "mesher/geometry/surface.hpp"
#include "mesher/volume/volume_mesh.hpp"

namespace palpate::mesher {

/// The faces of one tetrahedron only, oriented outward, in the order of the tetrahedra.
std::vector<Triangle> boundary_facets(const std::vector<Tetrahedron>& tetrahedra);

/// The boundary as a surface of its own: its points are the boundary nodes in ascending order.
Surface boundary_surface(const VolumeMesh& mesh);

/// Nodes of edges with more than two boundary facets, and nodes at which several sheets of the
/// boundary touch; ascending. Empty for a manifold boundary.
std::vector<std::int32_t> non_manifold_nodes(const std::vector<Triangle>& boundary);

/// The number of the set of tetrahedra connected by faces that each tetrahedron belongs to;
/// sets are numbered by their first tetrahedron.
std::vector<std::int32_t> connected_sets(const std::vector<Tetrahedron>& tetrahedra);

}  // namespace palpate::mesher
