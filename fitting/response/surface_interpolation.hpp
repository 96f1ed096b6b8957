// SPDX-License-Identifier: AGPL-3.0-or-later
// Values on a surface from values at scattered vertices of it.
#pragma once

#include <cstddef>
#include <vector>

#include "format/vec3.hpp"

namespace palpate::fitting {

/// A vertex of known value and its weight in an interpolated value.
struct Donor {
  std::size_t vertex = 0;
  double weight = 0;
};

/// Distance of two vertices for interpolation, m: their Euclidean distance, increased up to
/// threefold where their press directions differ (at an edge), and infinite for directions more
/// than 78 degrees apart (the other side of a thin body).
double interpolation_distance(const std::vector<Vec3>& positions, const std::vector<Vec3>& inward,
                              std::size_t a, std::size_t b);

/// Interpolates by thin plate splines [Duchon 1977] through the nearest donors of a vertex, laid
/// out in its tangent plane at their true distances. Exact at donors and for linear fields on a
/// plane. Where the donors lie on one side or on a line, so that a spline would extrapolate,
/// inverse squared distances are the weights [Shepard 1968]. Deterministic and immutable: safe to
/// use from any thread.
class SurfaceInterpolation {
 public:
  /// @param donors vertices with values, ascending. Positions and directions (unit) must outlive
  ///   this object.
  SurfaceInterpolation(const std::vector<Vec3>& positions, const std::vector<Vec3>& inward,
                       std::vector<std::size_t> donors);

  /// Weights, of sum 1, for the value at `vertex`. A vertex is never its own donor, so at a donor
  /// this is the leave-one-out interpolation. Empty when no donor has a finite distance.
  std::vector<Donor> weights(std::size_t vertex) const;

  /// The `count` nearest donors of `vertex` but itself, nearest first, with their
  /// interpolation_distance in `weight`.
  std::vector<Donor> nearest(std::size_t vertex, std::size_t count) const;

 private:
  const std::vector<Vec3>& positions_;
  const std::vector<Vec3>& inward_;
  std::vector<std::size_t> donors_;
};

}  // namespace palpate::fitting
