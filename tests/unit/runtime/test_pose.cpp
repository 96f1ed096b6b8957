// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace palpate::test {
namespace {

using runtime::Pose;

/// A turn by 120 degrees about (1, 1, 1), x -> y -> z -> x, and a shift.
Pose turned() {
  return {{{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}}, {0.5, -0.2, 0.1}};
}

TEST(Pose, OfABodyThatWasNotMovedIsTheIdentity) {
  const Vec3 x{0.1, -0.2, 0.3};
  EXPECT_EQ(Pose{}.to_world(x), x);
  EXPECT_EQ(Pose{}.to_body(x), x);
  EXPECT_TRUE(Pose{}.is_rigid(0));
}

TEST(Pose, TakesPointsToTheWorldAndBack) {
  const Vec3 x{0.1, -0.2, 0.3};
  EXPECT_NEAR(norm(turned().to_world(x) - Vec3{0.8, -0.1, -0.1}), 0, 1e-15);
  EXPECT_NEAR(norm(turned().to_body(turned().to_world(x)) - x), 0, 1e-15);
}

TEST(Pose, TurnsDirectionsWithoutShiftingThem) {
  EXPECT_EQ(turned().turn({1, 0, 0}), (Vec3{0, 1, 0}));
}

TEST(Pose, IsRigidOnlyWithAnOrthonormalRightHandedFiniteRotation) {
  EXPECT_TRUE(turned().is_rigid(1e-12));
  Pose mirrored = turned();
  mirrored.rotation[2] = -mirrored.rotation[2];
  EXPECT_FALSE(mirrored.is_rigid(1e-12));
  Pose stretched = turned();
  stretched.rotation[0] = 1.001 * stretched.rotation[0];
  EXPECT_FALSE(stretched.is_rigid(1e-6));
  EXPECT_TRUE(stretched.is_rigid(1e-2));
  Pose nowhere;
  nowhere.position[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(nowhere.is_rigid(1));
  Pose undefined;
  undefined.rotation[1][1] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(undefined.is_rigid(1));
}

}  // namespace
}  // namespace palpate::test
