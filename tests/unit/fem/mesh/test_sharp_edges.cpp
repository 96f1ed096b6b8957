// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/mesh/sharp_edges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

constexpr double kWidth = 0.03, kHeight = 0.02;

Body sharp_block() {
  return test::make_block(test::even(0, kWidth, 3), test::even(0, kWidth, 3),
                          test::even(0, kHeight, 2));
}

double total_length(const Body& body) {
  double total = 0;
  for (const auto& [a, b] : sharp_edges(body)) total += norm(a - b);
  return total;
}

/// The twelve edges of a block, and none of the edges between facets of one face.
TEST(SharpEdges, AreThoseOfABlock) {
  EXPECT_NEAR(total_length(sharp_block()), 8 * kWidth + 4 * kHeight, 1e-12);
}

/// A roof whose sides fall by 30 degrees each has a sharp ridge, one of 20 degrees has none.
TEST(SharpEdges, AreSharperThanHalfARightAngle) {
  const auto ridge = [](double angle) {
    Body body = test::make_block(test::even(-0.01, 0.01, 2), test::even(0, kWidth, 3),
                                 test::even(0, kHeight, 2));
    const double before = total_length(body);
    test::deform(body, [&](const Vec3& x) {
      return Vec3{x[0], x[1], x[2] * (1 - std::abs(x[0]) * std::tan(angle) / kHeight)};
    });
    double along = 0;
    for (const auto& [a, b] : sharp_edges(body))
      if (a[0] == 0 && b[0] == 0 && std::min(a[2], b[2]) > 0.9 * kHeight) along += norm(a - b);
    EXPECT_GT(before, 0);
    return along;
  };
  EXPECT_NEAR(ridge(std::numbers::pi / 6), kWidth, 1e-12);
  EXPECT_EQ(ridge(std::numbers::pi / 9), 0);
}

TEST(SharpEdges, AreNearVerticesWithinReach) {
  const Body body = sharp_block();
  const auto near = near_sharp_edges(body, 0.005), far = near_sharp_edges(body, 0.0101);
  ASSERT_EQ(near.size(), body.response.node.size());
  for (std::size_t v = 0; v < near.size(); ++v) {
    const Vec3& x = body.nodes[to_index(body.response.node[v])];
    const double distance = std::min({x[0], x[1], kWidth - x[0], kWidth - x[1]});
    EXPECT_EQ(near[v], distance < 1e-9);
    EXPECT_TRUE(far[v]);
  }
}

}  // namespace
}  // namespace palpate::fem
