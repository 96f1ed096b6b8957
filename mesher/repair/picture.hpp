// SPDX-License-Identifier: AGPL-3.0-or-later
// What a repair did to a surface, to be looked at.
#pragma once

#include <vector>

#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

/// A surface, coarse enough to draw, and how far each of its points lies from another one.
struct ColouredSurface {
  std::vector<Vec3> points;  ///< m
  std::vector<Triangle> triangles;
  std::vector<double> distance;  ///< m, of each point
};

/// The faces of the file that were kept, with their distances from the repaired surface, and that
/// surface, with its distances from those faces.
struct RepairPicture {
  ColouredSurface file, repaired;
};

/// Both surfaces with points of a grid of `cells` cells along the largest dimension of the file
/// merged: a merged point lies at one of them, and has the largest distance of all of them.
/// Triangles with edges of more than three cells are divided.
RepairPicture picture_of_repair(const Surface& file, const Surface& repaired, int cells);

}  // namespace palpate::mesher
