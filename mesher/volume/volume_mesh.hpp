// SPDX-License-Identifier: AGPL-3.0-or-later
// Tetrahedra of a body, whatever made them: before supports and a response surface are chosen.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "format/body.hpp"
#include "format/vec3.hpp"

namespace palpate::mesher {

struct VolumeMesh {
  std::vector<Vec3> nodes;                ///< m; each is a corner of a tetrahedron
  std::vector<Tetrahedron> tetrahedra;    ///< positive volume
  std::vector<std::int32_t> region;       ///< of each tetrahedron, index into region_names
  std::vector<std::string> region_names;  ///< region 0 is the matrix
  std::vector<CurvedEdge> curved_edges;   ///< ascending ends; only edges of the boundary
  /// Named sets of nodes, for supports and press zones: the groups and sets of a mesh file.
  std::map<std::string, std::vector<std::int32_t>> node_sets;
};

}  // namespace palpate::mesher
