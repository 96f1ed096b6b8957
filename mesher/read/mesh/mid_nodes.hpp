// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "format/body.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/read/mesh/mesh_entities.hpp"

namespace palpate::mesher {

/// The curved edges of the boundary, by the mid-nodes of quadratic tetrahedra. Indices are those of
/// MeshEntities::nodes, whose coordinates are in metres.
/// @throws Error(Geometry) where the tetrahedra around an edge have different mid-nodes, or a
///   boundary edge bulges by more than kMostBulge of its length.
std::vector<CurvedEdge> curved_boundary_edges(const MeshEntities& entities,
                                              const std::vector<Triangle>& boundary,
                                              const std::string& where, const Log& log);

}  // namespace palpate::mesher
