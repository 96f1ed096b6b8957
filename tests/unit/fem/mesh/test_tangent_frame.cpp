// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/mesh/tangent_frame.hpp"

#include <gtest/gtest.h>

namespace palpate::fem {
namespace {

TEST(TangentFrame, IsRightHandedAndOrthonormal) {
  for (const Eigen::Vector3d& n :
       {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1, 2, 3).normalized()}) {
    const auto [a, b] = tangent_frame(n);
    EXPECT_NEAR(a.norm(), 1, 1e-14);
    EXPECT_LT((a.cross(b) - n).norm(), 1e-14);
  }
}

/// Azimuth 0 is part of the format of the curves: a library is useless if it moves.
TEST(TangentFrame, StartsNormalToTheAxisOfTheSmallestComponent) {
  const auto down = tangent_frame(Eigen::Vector3d(0, 0, -1));
  EXPECT_EQ(down[0], Eigen::Vector3d(0, -1, 0));
  EXPECT_EQ(down[1], Eigen::Vector3d(-1, 0, 0));
  const Eigen::Vector3d n = Eigen::Vector3d(3, -1, 2).normalized();
  EXPECT_EQ(tangent_frame(n)[0][1], 0);
}

}  // namespace
}  // namespace palpate::fem
