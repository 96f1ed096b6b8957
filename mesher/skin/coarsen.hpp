// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

/// A response surface whose points are points of the boundary.
struct CoarseSurface {
  Surface surface;
  std::vector<std::int32_t> fine_point;  ///< of each of its points: index into the fine surface
};

/// Coarsens a closed, manifold surface to edges near `spacing` (m) by half-edge collapses, shortest
/// edge first, and edge flips: the points that remain do not move. Creases with a dihedral
/// deviation over `feature_angle` (rad), where they are longer than a few spacings, keep their
/// shape. An edge stays where its removal would turn a triangle away from the normals of the fine
/// surface at its corners, flatten it, or change the topology: in thin and strongly curved places
/// the result is finer than the spacing.
CoarseSurface coarsen(const Surface& fine, double spacing, double feature_angle);

}  // namespace palpate::mesher
