// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "mesher/geometry/thickness.hpp"
#include "mesher/skin/remesh.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

TEST(Thickness, OfABoxIsItsHeightAlsoWhereTheLineGrazesASide) {
  const NestedSurface nested =
      remesh(test::box({0, 0, 0}, {0.06, 0.06, 0.03}), {0.010, 1, 45}, "box", {});
  const std::vector<Vec3> down(nested.response.points.size(), Vec3{0, 0, -1});
  const auto thickness = thickness_under_tool(nested.boundary, down, 0.005);
  std::size_t edge_points = 0;
  for (std::size_t v = 0; v < down.size(); ++v) {
    const Vec3& x = nested.response.points[v];
    if (x[2] < 0.03 - 1e-9) continue;
    if (x[0] < 1e-9 || x[0] > 0.06 - 1e-9) ++edge_points;
    EXPECT_NEAR(thickness[v], 0.03, 1e-9) << x[0] << ' ' << x[1];
  }
  EXPECT_GT(edge_points, 4U);
}

TEST(Thickness, ThinMaterialBesideASharpEdgeIsThin) {
  // A wedge of 45 degrees: the line down from (x, y, z = x) on its sloping side is x long.
  Surface wedge;
  wedge.points = {{0, 0, 0},    {0.05, 0, 0},    {0.05, 0, 0.05},
                  {0, 0.05, 0}, {0.05, 0.05, 0}, {0.05, 0.05, 0.05}};
  wedge.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1},
                     {1, 4, 5}, {1, 5, 2}, {0, 2, 5}, {0, 5, 3}};
  ASSERT_GT(signed_volume(wedge), 0);
  const NestedSurface nested = remesh(wedge, {0.008, 1, 30}, "wedge", {});
  const Vec3 inward = unit(Vec3{1, 0, -1});
  const std::vector<Vec3> directions(nested.response.points.size(), inward);
  const auto thickness = thickness_under_tool(nested.boundary, directions, 0.005);
  std::size_t inside = 0;
  for (std::size_t v = 0; v < thickness.size(); ++v) {
    const Vec3& x = nested.response.points[v];
    const bool on_slope =
        std::abs(x[2] - x[0]) < 1e-9 && x[0] > 1e-3 && x[0] < 0.02 && x[1] > 1e-3 && x[1] < 0.049;
    if (!on_slope) continue;
    ++inside;
    EXPECT_NEAR(thickness[v], std::sqrt(2.0) * x[0], 1e-9);
  }
  EXPECT_GT(inside, 3U);
}

}  // namespace
}  // namespace palpate::mesher
