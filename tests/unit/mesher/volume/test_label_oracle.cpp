// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/label_oracle.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace palpate::mesher {
namespace {

/// A ball of radius 2 with a core of radius 1.
LabelField ball() {
  LabelField field;
  field.box = {{-2.5, -2.5, -2.5}, {2.5, 2.5, 2.5}};
  field.resolution = 0.1;
  field.region_names = {"matrix", "core"};
  field.region = [](const Vec3& x) {
    const double r = norm(x);
    return r > 2 ? kVoid : r > 1 ? 0 : 1;
  };
  return field;
}

TEST(LabelOracle, KnowsTheRegionsAndTheVolume) {
  const auto oracle = make_oracle(ball());
  EXPECT_EQ(oracle->region({0, 0, 0.9}), 1);
  EXPECT_EQ(oracle->region({0, 1.5, 0}), 0);
  EXPECT_EQ(oracle->region({0, 2.1, 0}), kVoid);
  EXPECT_EQ(oracle->region({0, 9, 0}), kVoid);
  EXPECT_FALSE(oracle->has_one_region());
  // By counting cells of the resolution, one in 40 across the ball.
  const double volume = 4 * std::numbers::pi / 3 * 8;
  EXPECT_NEAR(oracle->volume(), volume, 0.01 * volume);
  EXPECT_LE(oracle->box().low[0], -1.95);
  EXPECT_GE(oracle->box().high[2], 1.95);
}

TEST(LabelOracle, CrossingsLieOnTheInterfaces) {
  const auto oracle = make_oracle(ball());
  const auto inner = oracle->crossing({0, 0, 0}, {1.5, 0, 0});
  ASSERT_TRUE(inner.has_value());
  EXPECT_NEAR(inner->point[0], 1, 1e-3);
  EXPECT_EQ(inner->low, 0);
  EXPECT_EQ(inner->high, 1);
  const auto outer = oracle->crossing({0, 3, 0}, {0, 1.5, 0});
  ASSERT_TRUE(outer.has_value());
  EXPECT_NEAR(outer->point[1], 2, 1e-3);
  EXPECT_EQ(outer->low, kVoid);
  EXPECT_EQ(outer->high, 0);
  EXPECT_FALSE(oracle->crossing({0, 0, 1.2}, {0, 0, 1.8}).has_value());
}

TEST(LabelOracle, SeedsCoverBothInterfacesAndKeepTheirDistance) {
  const auto oracle = make_oracle(ball());
  const auto seeds = oracle->seeds([](const Vec3&) { return 0.5; });
  double inner = 0, outer = 0;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const bool is_inner = seeds[i].high == 1;
    EXPECT_NEAR(norm(seeds[i].point), is_inner ? 1 : 2, 1e-2);
    EXPECT_LT(oracle->distance(seeds[i].point), 0.1);
    (is_inner ? inner : outer) += 1;
    for (std::size_t j = 0; j < i; ++j) {
      if ((seeds[j].high == 1) != is_inner) continue;
      EXPECT_GE(norm(seeds[i].point - seeds[j].point), 0.5);
    }
  }
  // Discs of half the spacing do not overlap, and discs of the spacing cover.
  const double area = 4 * std::numbers::pi;
  EXPECT_GT(inner, area / (std::numbers::pi * 0.25));
  EXPECT_LT(inner, 1.3 * area / (std::numbers::pi * 0.0625));
  EXPECT_GT(outer, 4 * area / (std::numbers::pi * 0.25));
}

}  // namespace
}  // namespace palpate::mesher
