// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/init/first_sizes.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "mesher/read/read_surface.hpp"
#include "tests/support/source_folder.hpp"

namespace palpate::app {
namespace {

FirstSizes sizes_of(const char* file, double unit, int sites) {
  const mesher::Surface surface =
      mesher::read_surface({test::source_folder() / file, unit, ""}, {});
  return first_sizes(surface, find_base(surface), sites);
}

TEST(FirstSizes, OfACylinderFollowItsAreaAndThickness) {
  const FirstSizes sizes = sizes_of("data/bodies/cylinder.off", 1e-3, 200);
  const double pi = std::numbers::pi, r = 0.04, h = 0.074;
  const double area = pi * r * r + 2 * pi * r * h;  // without the cap that it stands on
  EXPECT_NEAR(sizes.pressable_area, area, 0.02 * area);
  EXPECT_NEAR(sizes.thickness, 2 * r, 0.01 * r);  // below the side, which is most of it
  const double sites = 2 * area /
                       (std::numbers::sqrt3 / 2 * 2 * sizes.patch_spacing *
                        sizes.patch_spacing);  // one vertex for two triangles
  EXPECT_NEAR(sites, 200, 20);
}

TEST(FirstSizes, ShowTheShapeHoweverFewSitesAreAskedFor) {
  const FirstSizes sizes = sizes_of("data/bodies/cylinder.off", 1e-3, 10);
  EXPECT_TRUE(sizes.is_coarsest);
  EXPECT_NEAR(sizes.patch_spacing, 0.08 / 6, 1e-3 * 0.5);  // a sixth of the diameter
  EXPECT_FALSE(sizes_of("data/bodies/cylinder.off", 1e-3, 200).is_coarsest);
}

TEST(FirstSizes, ScaleWithTheBody) {
  const FirstSizes large = sizes_of("data/bodies/organ.off", 1e-2, 150);
  const FirstSizes small = sizes_of("data/bodies/organ.off", 1e-3, 150);
  EXPECT_NEAR(large.patch_spacing, 10 * small.patch_spacing, 1e-9 * large.patch_spacing);
  EXPECT_NEAR(large.depth, 10 * small.depth, 1e-9 * large.depth);
}

TEST(FirstSizes, PressNoDeeperThanAThirdOfAThinWall) {
  const FirstSizes bowl = sizes_of("tests/data/surfaces/sofa/salad_bowl.obj", 1, 200);
  EXPECT_TRUE(bowl.is_thin);
  EXPECT_LE(bowl.depth, 0.34 * bowl.thickness);
}

TEST(FirstSizes, OfOneBodyStandInOrder) {
  const FirstSizes sizes = sizes_of("data/bodies/sofa/liver.obj", 0.1, 200);
  EXPECT_FALSE(sizes.is_thin);
  EXPECT_GT(sizes.patch_spacing, sizes.tool_radius);
  EXPECT_GT(sizes.tool_radius, sizes.element_size);
  EXPECT_GT(sizes.tool_radius, sizes.depth);
  EXPECT_GT(sizes.depth, sizes.lateral_travel);
  EXPECT_GT(sizes.lateral_travel, 0);
}

}  // namespace
}  // namespace palpate::app
