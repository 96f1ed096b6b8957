// SPDX-License-Identifier: AGPL-3.0-or-later
// Holes of a surface: where they are, and patches that close them.
#pragma once

#include <vector>

#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

/// A hole, as its border shows it.
struct Hole {
  Vec3 centre{};
  double diameter = 0;   ///< m, diagonal of the bounding box of the border
  double flatness = 0;   ///< m, largest distance of the border from its mean plane
  double area = 0;       ///< m^2, of the patch that fills it
  bool is_cone = false;  ///< filled by triangles from the border to its centre

  /// A flat cut: its patch lies in the plane of the border.
  bool is_flat() const;
};

/// Fills every hole, whatever its size: with the patch of least dihedral angles and area [Liepa
/// 2003] among the triangles of a Delaunay triangulation, refined to the density of its border; or,
/// where there is none, with a cone about the centre of the border.
/// A patch may cross the surface. Longer borders than a few hundred edges never take the cubic
/// search.
/// @pre the surface is manifold
/// @returns the holes
std::vector<Hole> fill_holes(Surface& surface);

}  // namespace palpate::mesher
