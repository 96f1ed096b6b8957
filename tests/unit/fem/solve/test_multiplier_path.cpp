// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/multiplier_path.hpp"

#include <gtest/gtest.h>

namespace palpate::fem {
namespace {

/// A tool that goes down and then aside: its travel is the length of the way.
Eigen::Vector3d tip_at(double s) {
  return s < 1 ? Eigen::Vector3d(0, 0, -s) : Eigen::Vector3d(s - 1, 0, -1);
}

std::vector<double> quadratic(double s) {
  return {1 + s, s * s, 3 - 2 * s + 0.5 * s * s};
}

TEST(MultiplierPath, ExtrapolatesAlongTheWayOfTheTool) {
  MultiplierPath path;
  EXPECT_TRUE(path.empty());
  path.start(tip_at(0), quadratic(0));
  for (const double s : {0.5, 1.0, 1.2, 1.5}) path.add(tip_at(s), quadratic(s));
  const std::vector<double> predicted = path.predict(tip_at(1.9));
  for (std::size_t e = 0; e < predicted.size(); ++e)
    EXPECT_NEAR(predicted[e], quadratic(1.9)[e], 1e-11);
  EXPECT_EQ(path.last(), quadratic(1.5));
}

TEST(MultiplierPath, BeginsAnewAtAStartAndWhereTheToolDoesNotMove) {
  MultiplierPath path;
  path.start(tip_at(0), quadratic(0));
  path.add(tip_at(0.5), quadratic(0.5));
  path.start(tip_at(0.2), quadratic(0.2));
  EXPECT_EQ(path.predict(tip_at(0.9)), quadratic(0.2));
  path.add(tip_at(0.2), quadratic(0.7));
  EXPECT_EQ(path.predict(tip_at(0.9)), quadratic(0.7));
}

}  // namespace
}  // namespace palpate::fem
