// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesher/response/response.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

TEST(InwardDirections, CubeEdgesAndCornersBisectTheirSides) {
  const Surface box = test::box({0, 0, 0}, {1, 1, 1});
  const auto directions = inward_directions(box, box, std::vector<std::uint8_t>(8, 0));
  EXPECT_TRUE(directions.unresolved.empty());
  const Vec3 exact = unit(Vec3{1, 1, 1});
  EXPECT_NEAR(norm(directions.inward[0] - exact), 0, 1e-12);
  EXPECT_EQ(directions.adjusted, 0U);
  EXPECT_EQ(directions.largest_turn, 0);
}

TEST(InwardDirections, FollowTheFreeSideBesideASupport) {
  const Surface box = test::box({0, 0, 0}, {1, 1, 1});
  std::vector<std::uint8_t> fixed(8, 0);
  for (std::size_t v = 0; v < 4; ++v) fixed[v] = 1;  // the bottom
  const auto directions = inward_directions(box, box, fixed);
  EXPECT_NEAR(directions.inward[0][2], 0, 1e-12);
  EXPECT_GT(directions.inward[0][0], 0.4);
  EXPECT_GT(directions.inward[0][1], 0.4);
}

TEST(InwardDirections, ReportASpikeThatIsTooSharp) {
  // At the tip of a needle the sides nearly face away from one another; the mean still points in.
  Surface needle;
  needle.points = {{0, 0, 1}, {0.02, 0, 0}, {-0.01, 0.017, 0}, {-0.01, -0.017, 0}};
  needle.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  ASSERT_GT(signed_volume(needle), 0);
  const auto directions = inward_directions(needle, needle, {0, 0, 0, 1});
  // No direction has a cosine of 0.1 with the normals of all three sides.
  EXPECT_THAT(directions.unresolved, testing::Contains(0));
}

TEST(InwardDirections, ReportTheLargestTurnAndItsVertex) {
  // Leaning spikes, the mean of whose facets does not point into all of them.
  int turned = 0;
  for (int lean = 0; lean < 12; ++lean) {
    Surface spike;
    spike.points = {{0.2 * lean, 0, 0.5}, {1, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.8, 0}};
    spike.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
    const auto directions = inward_directions(spike, spike, {0, 0, 0, 0});
    std::vector<Vec3> sum(4, Vec3{});
    for (const Triangle& t : spike.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto at = [&](std::size_t i) {
          return spike.points[static_cast<std::size_t>(t[i % 3])];
        };
        const Vec3 a = at(k + 1) - at(k), b = at(k + 2) - at(k);
        const double angle = std::acos(dot(a, b) / (norm(a) * norm(b)));
        Vec3& mean = sum[static_cast<std::size_t>(t[k])];
        mean = mean - angle * unit(cross(at(1) - at(0), at(2) - at(0)));
      }
    }
    double largest = 0;
    for (std::size_t v = 0; v < 4; ++v) {
      const double cosine = dot(unit(sum[v]), directions.inward[v]);
      largest = std::max(largest, std::acos(std::min(1.0, cosine)));
    }
    turned += directions.adjusted > 0 ? 1 : 0;
    EXPECT_NEAR(directions.largest_turn, largest, 1e-6);
    EXPECT_NEAR(std::acos(dot(unit(sum[directions.turned_most]),
                              directions.inward[directions.turned_most])),
                largest, 1e-6);
  }
  EXPECT_EQ(turned, 12);  // the rim of so flat a body is as sharp as its tip
}

}  // namespace
}  // namespace palpate::mesher
