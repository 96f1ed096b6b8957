// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesher/geometry/surface.hpp"
#include "mesher/mesher.hpp"
#include "tests/unit/mesher/body_checks.hpp"
#include "tests/unit/mesher/refusals.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

using std::numbers::pi;
using test::cube;
using test::expect_refused;
using test::off_text;
using test::settings_for;
using test::TemporaryFile;

TEST(Inclusions, AreTheirOwnRegionAndVolumesAddUp) {
  constexpr double radius = 0.012;
  const test::TemporaryFile skin("skin.off",
                                 test::off_text(test::box({-0.03, -0.03, 0}, {0.03, 0.03, 0.04})));
  const test::TemporaryFile ball("ball.off",
                                 test::off_text(test::sphere({0, 0, 0.022}, radius, 120)));
  Settings s;
  s.surface = {skin.path(), 1.0, "fat"};
  s.inclusions = {{ball.path(), 1.0, "nodule"}};
  s.supports = {BoxSupport{{-1, -1, -1}, {1, 1, 0}}};
  s.patch_spacing = 0.006;
  s.element_size = 0.003;
  const Body body = mesh(s);
  test::expect_sound(body);
  EXPECT_EQ(body.region_names, (std::vector<std::string>{"fat", "nodule"}));
  EXPECT_NEAR(test::volume_of_region(body, -1) / (0.06 * 0.06 * 0.04), 1, 1e-9);
  EXPECT_NEAR(test::volume_of_region(body, 1), signed_volume(test::sphere({}, radius, 120)),
              1e-6 * std::pow(radius, 3));
  EXPECT_NEAR(test::volume_of_region(body, 0) + test::volume_of_region(body, 1),
              test::volume_of_region(body, -1), 1e-15);
}

// Chords as long as the radius would remove 3 h^2/(8 r^2) of the volume, more than a third; flat
// faces lose nothing, and their corners stay.
TEST(Inclusions, KeepTheirVolumeOnLargeElements) {
  const TemporaryFile skin("skin.off", off_text(test::box({-30, -30, 0}, {30, 30, 40})));
  const TemporaryFile ball("ball.off", off_text(test::sphere({12, 0, 22}, 8, 60)));
  const TemporaryFile brick("brick.off", off_text(test::box({-20, -6, 14}, {-8, 6, 26})));
  Settings s;
  s.surface = {skin.path(), 0.001, "fat"};
  s.inclusions = {{ball.path(), 0.001, "ball"}, {brick.path(), 0.001, "brick"}};
  s.supports = {BoxSupport{{-1, -1, -1}, {1, 1, 0}}};
  s.patch_spacing = s.element_size = 0.008;
  const Body body = mesh(s);
  test::expect_sound(body);
  const double of_ball = 1e-9 * signed_volume(test::sphere({}, 8, 60));
  EXPECT_NEAR(test::volume_of_region(body, 1), of_ball, 1e-3 * of_ball);
  EXPECT_NEAR(test::volume_of_region(body, 2), 12 * 12 * 12 * 1e-9, 1e-15);
}

TEST(Inclusions, MayNestCrossAndLeaveTheSkinButNotLieOutside) {
  const TemporaryFile skin("skin.off", off_text(cube()));
  const auto with = [&](const TemporaryFile& inclusion) {
    Settings s = settings_for(skin.path());
    s.inclusions = {{inclusion.path(), 1, "nodule"}};
    return s;
  };
  const TemporaryFile outside("outside.off", off_text(test::sphere({0.2, 0, 0}, 0.01, 16)));
  expect_refused(with(outside), "outside.off", "outside the body", "unit");
  Settings isotropic = with(outside);
  isotropic.method = MeshMethod::Isotropic;
  const TemporaryFile across("across.off", off_text(test::sphere({0, 0.02, 0.02}, 0.01, 16)));
  isotropic.inclusions = {{across.path(), 1, "nodule"}};
  expect_refused(isotropic, "skin.off", "intersects the skin", "move");

  const TemporaryFile inner("inner.off", off_text(test::sphere({0.025, 0.025, 0.025}, 0.006, 16)));
  const TemporaryFile outer("outer.off", off_text(test::sphere({0.025, 0.025, 0.025}, 0.015, 16)));
  Settings nested = with(outer);
  nested.patch_spacing = nested.element_size = 0.006;
  nested.inclusions.push_back({inner.path(), 1, "core"});
  nested.inclusions.push_back({across.path(), 1, "cut"});
  const Body body = mesh(nested);
  test::expect_sound(body);
  EXPECT_EQ(body.region_names, (std::vector<std::string>{"matrix", "nodule", "core", "cut"}));
  const double half = 2 * pi / 3 * 1e-6;  // the half of the last ball that is inside the skin
  EXPECT_NEAR(test::volume_of_region(body, 3), half, 0.3 * half);
  EXPECT_GT(test::volume_of_region(body, 1), test::volume_of_region(body, 2));
  EXPECT_GT(test::volume_of_region(body, 2), 0);
}

}  // namespace
}  // namespace palpate::mesher
