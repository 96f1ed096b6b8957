// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/support/rigid_motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>

#include "format/to_index.hpp"

namespace palpate::mesher {
namespace {

// A rigid motion is free when its pivot is smaller than this part of the largest.
constexpr double kSmallestPivot = 1e-6;

/// The three translations, and the rotations about the axes by an angle of 1/length.
std::array<Vec3, 6> rigid_motions(const Vec3& x, double length) {
  const Vec3 r = (1 / length) * x;
  return {Vec3{1, 0, 0},        Vec3{0, 1, 0},        Vec3{0, 0, 1},
          Vec3{0, -r[2], r[1]}, Vec3{r[2], 0, -r[0]}, Vec3{-r[1], r[0], 0}};
}

/// a . K b for the stiffness K of the point.
double resistance(const SupportedPoint& point, const Vec3& a, const Vec3& b) {
  return point.across * dot(a, b) +
         (point.along - point.across) * dot(a, point.normal) * dot(b, point.normal);
}

}  // namespace

bool prevent_rigid_motion(const std::vector<SupportedPoint>& points) {
  double length = 0;
  for (const SupportedPoint& point : points)
    length = std::max(length, norm(point.x - points.front().x));
  if (length == 0) return false;
  Eigen::Matrix<double, 6, 6> K = Eigen::Matrix<double, 6, 6>::Zero();
  for (const SupportedPoint& point : points) {
    const auto motion = rigid_motions(point.x - points.front().x, length);
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < 6; ++b)
        K(a, b) += resistance(point, motion[to_index(a)], motion[to_index(b)]);
  }
  const Eigen::Matrix<double, 6, 1> pivots = K.ldlt().vectorD();
  return pivots.minCoeff() > kSmallestPivot * pivots.maxCoeff();
}

}  // namespace palpate::mesher
