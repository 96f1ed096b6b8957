// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/support/rigid_motion.hpp"

#include <gtest/gtest.h>

namespace palpate::mesher {
namespace {

constexpr Vec3 kOrigin{0, 0, 0}, kX{0.1, 0, 0}, kY{0, 0.1, 0}, kZ{0, 0, 0.1};

TEST(RigidMotion, IsPreventedByThreeFixedPointsThatAreNotOnALine) {
  EXPECT_TRUE(prevent_rigid_motion({{kOrigin}, {kX}, {kY}}));
  EXPECT_FALSE(prevent_rigid_motion({{kOrigin}, {kX}, {2 * kX}}));
  EXPECT_FALSE(prevent_rigid_motion({{kOrigin}, {kX}}));
  EXPECT_FALSE(prevent_rigid_motion({{kOrigin}, {kOrigin}}));
  EXPECT_FALSE(prevent_rigid_motion({}));
}

TEST(RigidMotion, IsFreeAlongDirectionsWithoutSprings) {
  const Vec3 up{0, 0, 1};
  const auto base = [&](double along, double across) {
    return std::vector<SupportedPoint>{
        {kOrigin, up, along, across}, {kX, up, along, across}, {kY, up, along, across}};
  };
  EXPECT_TRUE(prevent_rigid_motion(base(1, 0.01)));
  EXPECT_TRUE(prevent_rigid_motion(base(1, 1)));
  EXPECT_FALSE(prevent_rigid_motion(base(1, 0)));
  EXPECT_FALSE(prevent_rigid_motion(base(0, 1)));  // along the normal, and rotations across it
  auto corner = base(0, 1);
  corner.push_back({kZ, up, 0, 1});
  EXPECT_FALSE(prevent_rigid_motion(corner));  // along the normal
}

}  // namespace
}  // namespace palpate::mesher
