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

/// The boundary facets and the faces between tetrahedra of different regions, each once.
std::vector<Triangle> interface_facets(const VolumeMesh& mesh);

/// The boundary as a surface of its own: its points are the boundary nodes in ascending order.
Surface boundary_surface(const VolumeMesh& mesh);

/// Nodes of edges with more than two boundary facets, and nodes at which several sheets of the
/// boundary touch; ascending. Empty for a manifold boundary.
std::vector<std::int32_t> non_manifold_nodes(const std::vector<Triangle>& boundary);

/// The number of the set of tetrahedra connected by faces that each tetrahedron belongs to;
/// sets are numbered by their first tetrahedron.
std::vector<std::int32_t> connected_sets(const std::vector<Tetrahedron>& tetrahedra);

/// The set of the largest volume.
std::int32_t largest_set(const VolumeMesh& mesh, const std::vector<std::int32_t>& set);

/// Keeps one set of tetrahedra and their nodes.
void keep_set(VolumeMesh& mesh, const std::vector<std::int32_t>& set, std::int32_t kept);

/// Gives each set of tetrahedra that are connected by faces at a node a node of its own, so that
/// parts of the body that touch in a node or an edge come apart.
/// @return the number of new nodes, which lie where the old ones lie
std::size_t split_nodes(VolumeMesh& mesh);

}  // namespace palpate::mesher
