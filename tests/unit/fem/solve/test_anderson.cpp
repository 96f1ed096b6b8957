// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/anderson.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace palpate::fem {
namespace {

/// g(X) = S (target - X), S diagonal with three eigenvalues, of which two make the plain iteration
/// diverge: the secant model is exact after four steps.
TEST(Anderson, SolvesALinearProblemInAStepMoreThanItHasEigenvalues) {
  Eigen::Matrix3Xd X = Eigen::Matrix3Xd::Zero(3, 5);
  const Eigen::Matrix3Xd target = Eigen::Matrix3Xd::Constant(3, 5, 0.7);
  const Eigen::Vector3d S(0.4, 2.5, 3.1);
  Anderson anderson;
  for (int i = 0; i < 4; ++i) X += anderson.step(X, S.asDiagonal() * (target - X));
  EXPECT_LT((X - target).norm(), 1e-10);
}

TEST(Anderson, StartsWithThePlainStep) {
  const Eigen::Matrix3Xd X = Eigen::Matrix3Xd::Random(3, 4), g = Eigen::Matrix3Xd::Random(3, 4);
  EXPECT_EQ(Anderson().step(X, g), g);
}

}  // namespace
}  // namespace palpate::fem
