// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "mesher/surface.hpp"

namespace palpate::mesher {

/// Tetrahedra between closed surfaces.
struct Filling {
  std::vector<Vec3> nodes;              ///< m; the points of the surfaces first, in their order
  std::vector<Tetrahedron> tetrahedra;  ///< positive volume
  std::vector<std::int32_t> part;       ///< of each tetrahedron: equal inside one closed cell
  bool cut_short = false;               ///< refinement was stopped before sizes and angles were met
};

/// Fill the outermost of `shells` with tetrahedra whose faces contain every triangle of every shell
/// unchanged. Radius-edge ratio at most 1.3 away from the given triangles; tetrahedra with an edge
/// longer than `longest_edge` (m) are refined, except where a point would come too close to a given
/// triangle: edges next to the surfaces may exceed it by a fifth.
/// TetGen runs in a child process.
/// @throws Error(Geometry) when TetGen refuses the shells or breaks down, Error(Internal) when it
///   does not keep them.
Filling fill(const Surface& shells, double longest_edge, const std::string& where);

}  // namespace palpate::mesher
