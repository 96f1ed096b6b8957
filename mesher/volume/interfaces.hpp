// SPDX-License-Identifier: AGPL-3.0-or-later
// The facets between the regions of a volume mesh and around it.
#pragma once

#include <optional>
#include <vector>

#include "mesher/geometry/surface.hpp"
#include "mesher/volume/volume_mesh.hpp"

namespace palpate::mesher {

/// The boundary facets and the faces between tetrahedra of different regions, each once.
std::vector<Triangle> interface_facets(const VolumeMesh& mesh);

/// The boundary as a surface of its own: its points are the boundary nodes in ascending order.
Surface boundary_surface(const VolumeMesh& mesh);

/// The part of the largest volume, by the numbers of Adjacency::part.
std::int32_t largest_set(const VolumeMesh& mesh, const std::vector<std::int32_t>& set);

/// Keeps one set of tetrahedra and their nodes.
void keep_set(VolumeMesh& mesh, const std::vector<std::int32_t>& set, std::int32_t kept);

}  // namespace palpate::mesher
