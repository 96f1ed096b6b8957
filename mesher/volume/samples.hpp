// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <vector>

#include "mesher/geometry/surface.hpp"
#include "mesher/volume/oracle.hpp"

namespace palpate::mesher {

struct Sample {
  Vec3 point{};
  Vec3 outward{};  ///< unit normal of the triangle
};

/// Points inside the triangles, at most about `spacing` apart; at least one for each triangle that
/// has an area.
std::vector<Sample> sample_surface(const Surface& surface, double spacing);

/// The numbers of the points that remain when, in their order, each is dropped that lies nearer to
/// one kept before than `spacing` at the point.
std::vector<std::size_t> thinned(const std::vector<Vec3>& points, const SizeField& spacing);

/// The same for samples.
std::vector<Sample> thinned(const std::vector<Sample>& samples, const SizeField& spacing);

/// From the middle of a cube of 3 x 3 x 3 cells to the middle of cell n, in cells; zero for n = 13.
Vec3 towards_neighbour(int n);

}  // namespace palpate::mesher
