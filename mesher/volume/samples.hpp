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

/// Keeps samples in their order unless one kept before lies nearer than `spacing` at the sample.
std::vector<Sample> thinned(const std::vector<Sample>& samples, const SizeField& spacing);

}  // namespace palpate::mesher
