// SPDX-License-Identifier: AGPL-3.0-or-later
// Values on a surface from values at scattered vertices of it.
#pragma once

#include <cstddef>
#include <vector>

#include "format/vec3.hpp"

namespace palpate::fitting {

/// One vertex whose value is known, and its part in a value that is not.
struct Donor {
  std::size_t vertex = 0;
  double weight = 0;
};

/// How far apart two vertices are for what they feel like, m: their distance, up to three times as
/// much where their inward directions part (an edge), and infinite for directions more than 78
/// degrees apart (the other side of a thin body).
double interpolation_distance(const std::vector<Vec3>& positions, const std::vector<Vec3>& inward,
                              std::size_t a, std::size_t b);

/// Interpolates by thin plate splines [Duchon 1977] through the nearest donors of a vertex, laid
/// out in its tangent plane at their true distances: exact at donors, exact for linear fields on a
/// plane, and of third order for smooth ones. Where the donors lie on one side or on a line, so
/// that a spline would extrapolate, the inverse square of the distance weighs them [Shepard 1968].
/// Deterministic; immutable, any thread may ask.
class SurfaceInterpolation {
 public:
  /// @param donors vertices with values, ascending. Positions and directions (unit) must outlive
  ///   this object.
  SurfaceInterpolation(const std::vector<Vec3>& positions, const std::vector<Vec3>& inward,
                       std::vector<std::size_t> donors);

  /// Weights, of sum 1, for the value at `vertex`, which is never a donor of itself: asked at a
  /// donor, they tell what the others say of it. Empty when no donor is within sight.
  std::vector<Donor> weights(std::size_t vertex) const;

  /// The `count` nearest donors of `vertex` but itself, nearest first, with their felt distance in
  /// `weight`.
  std::vector<Donor> nearest(std::size_t vertex, std::size_t count) const;

 private:
  const std::vector<Vec3>& positions_;
  const std::vector<Vec3>& inward_;
  std::vector<std::size_t> donors_;
};

}  // namespace palpate::fitting
