// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/init/base.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mesher/read/read_surface.hpp"
#include "tests/support/source_folder.hpp"

namespace palpate::app {
namespace {

mesher::Surface body(const char* file, double unit) {
  return mesher::read_surface({test::source_folder() / "data/bodies" / file, unit, ""}, {});
}

/// Turned about the axis x by an angle (rad).
mesher::Surface tilted(mesher::Surface surface, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  for (Vec3& x : surface.points) x = {x[0], c * x[1] - s * x[2], s * x[1] + c * x[2]};
  return surface;
}

TEST(Base, IsTheFlatUndersideOfTheOrgan) {
  const Base base = find_base(body("organ.off", 1e-3));
  EXPECT_TRUE(base.is_flat);
  EXPECT_EQ(base.down, (Vec3{0, 0, -1}));
  EXPECT_NEAR(base.height, 0.026, 0.002);  // data/bodies/README.md: at z = -26 mm
  EXPECT_TRUE(base.holds({0, 0, -0.026}));
  EXPECT_FALSE(base.holds({0, 0, 0}));
}

TEST(Base, OfTwoLikeEndsIsTheLower) {
  const Base base = find_base(body("cylinder.off", 1e-3));
  EXPECT_TRUE(base.is_flat);
  EXPECT_EQ(base.down, (Vec3{0, 0, -1}));
  const double cap = 0.04 * 0.04, side = 2 * 0.04 * 0.074;  // radius 40 mm, height 74 mm; over pi
  EXPECT_NEAR(base.fraction, cap / (2 * cap + side), 0.005);
}

TEST(Base, OfABoxIsABroadSideHoweverItIsTurned) {
  const double angle = 0.7;
  const Base base = find_base(tilted(body("pad.off", 1e-3), angle));
  EXPECT_TRUE(base.is_flat);
  EXPECT_NEAR(std::abs(dot(base.down, {0, -std::sin(angle), std::cos(angle)})), 1, 1e-9);
  EXPECT_NEAR(base.fraction, 2500.0 / (2 * 2500 + 4 * 1000), 1e-9);
}

TEST(Base, OfARoundBodyIsALowSlabWithMoreThanTheWantedArea) {
  const mesher::Surface nodule = body("nodule.off", 1e-3);
  const Base base = find_base(nodule);
  EXPECT_FALSE(base.is_flat);
  EXPECT_EQ(base.down, (Vec3{0, 0, -1}));
  // The area of a zone of a sphere is proportional to its height [Archimedes].
  const mesher::Bounds box = mesher::bounds(nodule.points);
  const double height = -base.height - box.low[2];
  EXPECT_NEAR(base.fraction, height / (box.high[2] - box.low[2]), 0.02);
  EXPECT_GE(base.fraction, 0.15);
  EXPECT_LE(base.fraction, 0.25);
}

TEST(Base, OfTheLiverIsOneOfItsBroadSides) {
  const Base base = find_base(body("sofa/liver.obj", 0.1));
  EXPECT_EQ(base.down[0], 0);  // x is its longest axis: it does not stand on an end
  EXPECT_GE(base.fraction, 0.15);
}

}  // namespace
}  // namespace palpate::app
