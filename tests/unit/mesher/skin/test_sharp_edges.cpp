// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/skin/sharp_edges.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "format/to_index.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

TEST(SharpEdges, OfACylinderAreItsTwoRims) {
  constexpr int kAround = 24;
  const Surface cylinder = test::cylinder(0.02, 0.05, kAround);
  const std::vector<Edge> edges = sharp_edges(cylinder, std::numbers::pi / 4, 0.005);
  EXPECT_EQ(edges.size(), 2 * kAround);
  for (const Edge& edge : edges) {
    for (const std::int32_t v : edge) {
      const Vec3 x = cylinder.points[to_index(v)];
      EXPECT_NEAR(std::hypot(x[0], x[1]), 0.02, 1e-12);
      EXPECT_TRUE(x[2] == 0 || x[2] == 0.05) << x[2];
    }
  }
}

TEST(SharpEdges, ShortFragmentsAreNone) {
  const Surface box = test::box({0, 0, 0}, {0.01, 0.01, 0.01});
  EXPECT_EQ(sharp_edges(box, std::numbers::pi / 4, 0.01).size(), 12);
  EXPECT_TRUE(sharp_edges(box, std::numbers::pi / 4, 0.05).empty());
}

}  // namespace
}  // namespace palpate::mesher
