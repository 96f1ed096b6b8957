// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/surface_oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

Domain layered_box() {
  Domain domain;
  domain.skin = test::box({0, 0, 0}, {1, 1, 1});
  domain.layers = {{0.1, 1}, {0.2, 2}};
  domain.enclosures.push_back({test::sphere({0.5, 0.5, 0.5}, 0.1, 48), 3});
  domain.enclosures.push_back({test::box({0.4, 0.4, 0.9}, {0.6, 0.6, 1.5}), kVoid});
  domain.region_names = {"matrix", "skin", "fat", "core"};
  return domain;
}

TEST(SurfaceOracle, RegionsAreThoseOfTheLastEnclosureElseOfTheLayer) {
  const auto oracle = make_oracle(layered_box(), 1e-3);
  EXPECT_EQ(oracle->region({0.5, 0.5, 0.05}), 1);
  EXPECT_EQ(oracle->region({0.5, 0.5, 0.2}), 2);
  EXPECT_EQ(oracle->region({0.5, 0.65, 0.5}), 0);
  EXPECT_EQ(oracle->region({0.5, 0.5, 0.5}), 3);
  EXPECT_EQ(oracle->region({0.5, 0.5, 0.95}), kVoid);
  EXPECT_EQ(oracle->region({0.5, 0.5, 1.2}), kVoid);
  EXPECT_EQ(oracle->region({-0.1, 0.5, 0.5}), kVoid);
  EXPECT_FALSE(oracle->has_one_region());
  EXPECT_NEAR(oracle->volume(), 1 - 0.2 * 0.2 * 0.1, 1e-3);
  EXPECT_NEAR(oracle->distance({0.5, 0.2, 0.5}), 0.1, 1e-12);
}

TEST(SurfaceOracle, TheFirstChangeOfRegionAlongASegmentIsFound) {
  const auto oracle = make_oracle(layered_box(), 1e-3);
  Vec3 from{-0.2, 0.5, 0.5};
  const Vec3 to{0.5, 0.5, 0.5};
  const std::int32_t regions[] = {kVoid, 1, 2, 0, 3};
  const double at[] = {0, 0.1, 0.3, 0.4};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto crossing = oracle->crossing(from, to);
    ASSERT_TRUE(crossing);
    EXPECT_NEAR(crossing->point[0], at[i], 1e-3);  // the sphere is a polyhedron
    EXPECT_EQ(crossing->low, std::min(regions[i], regions[i + 1]));
    EXPECT_EQ(crossing->high, std::max(regions[i], regions[i + 1]));
    from = crossing->point + Vec3{2e-3, 0, 0};
  }
  EXPECT_FALSE(oracle->crossing({0.5, 0.62, 0.5}, {0.6, 0.65, 0.5}));
}

TEST(SurfaceOracle, SeedsLieOnEveryInterface) {
  const auto oracle = make_oracle(layered_box(), 1e-3);
  int skin = 0, wall = 0, core = 0;
  for (const Crossing& seed : oracle->seeds([](const Vec3&) { return 0.05; })) {
    EXPECT_LT(oracle->distance(seed.point), 1e-6);
    skin += seed.low == kVoid && seed.high == 1 ? 1 : 0;
    wall += seed.low == 1 && seed.high == 2 ? 1 : 0;
    core += seed.low == 0 && seed.high == 3 ? 1 : 0;
  }
  EXPECT_GT(skin, 100);
  EXPECT_GT(wall, 100);
  EXPECT_GT(core, 10);
}

}  // namespace
}  // namespace palpate::mesher
