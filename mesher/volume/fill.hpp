// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

/// Tetrahedra between closed surfaces.
struct Filling {
  std::vector<Vec3> nodes;              ///< m; the points of the surfaces first, in their order
  std::vector<Tetrahedron> tetrahedra;  ///< positive volume
  std::vector<std::int32_t> part;       ///< of each tetrahedron: equal inside one closed cell
  bool cut_short = false;               ///< refinement was stopped before sizes and angles were met
};

/// Fills the outermost of `shells` with tetrahedra. Every triangle of every shell is a face of a
/// tetrahedron. The radius-edge ratio is at most 1.3 away from the shells. Tetrahedra with an edge
/// longer than `longest_edge` (m) are refined, except where a new point would come too close to a
/// shell: edges beside the shells may be a fifth longer.
/// TetGen runs in a child process, because TetGen 1.5.0 crashes when it reports an error.
/// @throws Error(Geometry) when TetGen refuses the shells or crashes, Error(Internal) when its
///   result lacks a triangle of the shells.
Filling fill(const Surface& shells, double longest_edge, const std::string& where);

}  // namespace palpate::mesher
