// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/experiment/line_of_touch.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate::app::slingshot {
namespace {

constexpr double kStiffness = 170;  // N/m

/// Equation (34) in the units of the paper: 100 k x^2 up to 5 mm, then a line of slope k without a
/// step in force or slope.
TEST(WallForce, IsQuadraticAndThenLinear) {
  EXPECT_EQ(wall_force(kStiffness, -0.001), 0);
  EXPECT_DOUBLE_EQ(wall_force(kStiffness, 0.002), 100 * kStiffness * 4e-6);
  EXPECT_DOUBLE_EQ(wall_force(kStiffness, 0.010) - wall_force(kStiffness, 0.007),
                   kStiffness * 0.003);
  constexpr double h = 1e-7;
  EXPECT_NEAR(wall_force(kStiffness, kCurved + h), wall_force(kStiffness, kCurved - h),
              3 * kStiffness * h);
  const double before = (wall_force(kStiffness, kCurved) - wall_force(kStiffness, kCurved - h)) / h;
  const double after = (wall_force(kStiffness, kCurved + h) - wall_force(kStiffness, kCurved)) / h;
  EXPECT_NEAR(before, after, 1e-3 * kStiffness);
}

constexpr double kStep = 1e-6;  // m, between samples of the loop

/// Along the axis of symmetry a cylinder of such responses is the wall, from the sample on that
/// touched first.
TEST(LineOfTouch, ThroughTheAxisOfTheCylinderIsTheWall) {
  LineOfTouch line({VirtualBody::Cylinder, 0, 0.3, 2000, 0}, kStiffness);
  for (double depth = -0.001; depth < 0.012; depth += kStep)
    ASSERT_NEAR(line.force(depth), wall_force(kStiffness, depth), 1.01 * kStiffness * kStep + 1e-6);
}

/// Off the axis the surface is met at an angle, later on than at the depth 0 of its circle: between
/// the vertices a polygon lies inside.
TEST(LineOfTouch, OffTheAxisTakesMoreForceWithFrictionThanWithout) {
  LineOfTouch slippery({VirtualBody::Cylinder, 0.01, 0, 2000, 0}, kStiffness);
  LineOfTouch rough({VirtualBody::Cylinder, 0.01, 0.3, 2000, 0}, kStiffness);
  EXPECT_EQ(slippery.force(-0.001), 0);
  EXPECT_EQ(rough.force(-0.001), 0);
  double without = 0, with = 0;
  for (double depth = -0.001; depth < 0.010; depth += 1e-5) {
    without = slippery.force(depth);
    with = rough.force(depth);
  }
  EXPECT_GT(without, 0.5 * wall_force(kStiffness, 0.010));
  EXPECT_GT(with, 1.01 * without);
}

/// The search for triangles at a lower rate finds the same body, up to a period of it later.
TEST(LineOfTouch, DoesNotDependOnTheRateOfTheSearch) {
  constexpr int kPeriod = 20;  // samples
  LineOfTouch one({VirtualBody::Cylinder, 0, 0.3, 2000, 0}, kStiffness);
  LineOfTouch two({VirtualBody::Cylinder, 0, 0.3, 2000, 2000.0 / kPeriod}, kStiffness);
  for (double depth = -0.001; depth < 0.010; depth += kStep)
    ASSERT_NEAR(two.force(depth), one.force(depth), (kPeriod + 2) * kStiffness * kStep);
}

}  // namespace
}  // namespace palpate::app::slingshot
