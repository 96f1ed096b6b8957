// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/holes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesher/repair/soundness.hpp"
#include "tests/unit/mesher/repair/soups.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

constexpr double kRadius = 0.03;  // m

TEST(Holes, OfAClosedSurfaceAreNone) {
  Surface ball = test::sphere({0, 0, 0}, kRadius, 16);
  const std::vector<Triangle> triangles = ball.triangles;
  EXPECT_TRUE(fill_holes(ball).empty());
  EXPECT_EQ(ball.triangles, triangles);
}

TEST(Holes, TheEndsOfATubeAreFilledWithFlatDiscs) {
  constexpr int around = 48;
  constexpr double length = 0.1;  // m
  const Surface whole = test::cylinder(kRadius, length, around);
  const auto on_cap = [&](const Vec3& x) { return x[2] < 1e-9 || x[2] > length - 1e-9; };
  Surface tube = test::without(whole, on_cap);
  const std::vector<Hole> holes = fill_holes(tube);
  ASSERT_EQ(holes.size(), 2U);
  const double disc = around / 2.0 * kRadius * kRadius * std::sin(2 * std::numbers::pi / around);
  for (const Hole& hole : holes) {
    EXPECT_TRUE(hole.is_flat());
    EXPECT_FALSE(hole.is_cone);
    EXPECT_NEAR(hole.area, disc, 1e-9 * disc);
    EXPECT_NEAR(hole.diameter, 2 * std::numbers::sqrt2 * kRadius, 1e-12);
    EXPECT_NEAR(hole.centre[0], 0, 1e-12);
  }
  EXPECT_NEAR(std::abs(holes[0].centre[2] - holes[1].centre[2]), length, 1e-12);
  EXPECT_TRUE(is_sound(test::soup_of(tube)));
  EXPECT_NEAR(signed_volume(tube), disc * length, 1e-9 * disc * length);
}

TEST(Holes, ABorderThatLeavesItsPlaneIsNotFlat) {
  Surface shell = test::without(test::sphere({0, 0, 0}, kRadius, 32), [](const Vec3& x) {
    return x[0] > 0.3 * kRadius + 0.4 * std::abs(x[1]);
  });
  const std::vector<Hole> holes = fill_holes(shell);
  ASSERT_EQ(holes.size(), 1U);
  EXPECT_FALSE(holes[0].is_flat());
  EXPECT_TRUE(is_sound(test::soup_of(shell)));
}

}  // namespace
}  // namespace palpate::mesher
