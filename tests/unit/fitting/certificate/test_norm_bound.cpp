// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/norm_bound.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "format/numbers.hpp"

namespace palpate::fitting {
namespace {

using Entries = std::array<std::array<Range, 3>, 3>;

Entries around(const Eigen::Matrix3d& middle, double radius) {
  Entries entry;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const double m = middle(static_cast<int>(i), static_cast<int>(j));
      entry[i][j] = {m - radius, m + radius};
    }
  return entry;
}

double largest_singular_value(const Eigen::Matrix3d& M) {
  return Eigen::JacobiSVD<Eigen::Matrix3d>(M).singularValues()[0];
}

Eigen::Matrix3d random_rotation(std::mt19937& engine) {
  std::normal_distribution<double> any;
  return Eigen::Quaterniond(any(engine), any(engine), any(engine), any(engine))
      .normalized()
      .toRotationMatrix();
}

/// A bound between the norm by Jacobi rotations and a little more.
void expect_tight(const Eigen::Matrix3d& M, double looseness) {
  const double bound = kRoundingFactor * norm_bound(around(M, 0)), norm = largest_singular_value(M);
  EXPECT_GE(bound, norm);
  EXPECT_LE(bound, (1 + looseness) * norm);
}

TEST(NormBound, OfAMatrixIsItsNorm) {
  std::mt19937 engine(71);
  std::normal_distribution<double> any;
  for (int i = 0; i < 5000; ++i) {
    const double scale = std::pow(10, 3 * any(engine));
    const Eigen::Matrix3d M =
        scale * Eigen::Matrix3d::NullaryExpr([&](Eigen::Index) { return any(engine); });
    expect_tight(M, 1e-6);
  }
}

/// There the polynomial touches zero without crossing it, and round-off decides what is found.
TEST(NormBound, OfEqualAndOfNearlyEqualSingularValuesIsNotTooSmall) {
  std::mt19937 engine(72);
  for (int i = 0; i < 5000; ++i) {
    const double apart = i % 10 == 0 ? 0 : std::pow(10, -1.7 * (i % 10));
    const Eigen::Matrix3d U = random_rotation(engine), V = random_rotation(engine);
    expect_tight(U * Eigen::Vector3d(300, 300 * (1 - apart), 5).asDiagonal() * V, 1e-6);
    expect_tight(U * Eigen::Vector3d(7, 7 * (1 - apart), 7 * (1 - apart)).asDiagonal() * V, 3e-5);
    expect_tight(U * Eigen::Vector3d(400, 400 * apart, 0).asDiagonal() * V, 1e-6);
  }
}

TEST(NormBound, CoversEveryMatrixInTheRanges) {
  std::mt19937 engine(73);
  std::normal_distribution<double> any;
  std::uniform_real_distribution<double> within(-1, 1);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Matrix3d middle =
        Eigen::Matrix3d::NullaryExpr([&](Eigen::Index) { return any(engine); });
    const double radius = 0.3 * std::abs(any(engine));
    const double bound = norm_bound(around(middle, radius));
    for (int k = 0; k < 50; ++k) {
      const Eigen::Matrix3d corner =
          middle + radius * Eigen::Matrix3d::NullaryExpr(
                                [&](Eigen::Index) { return std::copysign(1.0, within(engine)); });
      EXPECT_LE(largest_singular_value(corner), kRoundingFactor * bound);
    }
    // The bound is reached by the Frobenius norm of a matrix of rank one.
    EXPECT_LE(bound, largest_singular_value(middle) * (1 + 1e-6) + 3 * radius * (1 + 1e-12));
  }
}

TEST(NormBound, OfZeroIsZeroAndOfInfinityInfinite) {
  EXPECT_EQ(norm_bound(around(Eigen::Matrix3d::Zero(), 0)), 0);
  Entries entry = around(Eigen::Matrix3d::Identity(), 0);
  entry[1][2] = {0, kInfinity};
  EXPECT_EQ(norm_bound(entry), kInfinity);
}

}  // namespace
}  // namespace palpate::fitting
