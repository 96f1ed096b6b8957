// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/specimen/grid_body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "format/to_index.hpp"

namespace palpate::fem {
namespace {

Vec3 minus(const Vec3& a, const Vec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double volume(const Body& body, const Tetrahedron& t) {
  const auto at = [&](std::size_t i) { return body.nodes[to_index(t[i])]; };
  const Vec3 a = minus(at(1), at(0)), b = minus(at(2), at(0)), c = minus(at(3), at(0));
  return (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
          a[2] * (b[0] * c[1] - b[1] * c[0])) /
         6;
}

Body sector() {
  return grid_body({{0, 1, 2.5}, {0, std::numbers::pi / 6}, {0, 1, 3}}, [](const Vec3& x) {
    return Vec3{x[0] * std::cos(x[1]), x[0] * std::sin(x[1]), x[2]};
  });
}

/// The cells of a sector are prisms over triangles with straight outer edges.
TEST(GridBody, FillsASectorAndClosesItAtItsAxis) {
  const Body body = sector();
  EXPECT_EQ(body.nodes.size(), 15U);  // 1 + 2 + 2 in each of three layers
  double whole = 0;
  for (const Tetrahedron& t : body.tetrahedra) {
    EXPECT_GT(volume(body, t), 1e-9);
    whole += volume(body, t);
  }
  EXPECT_NEAR(whole, 0.5 * 2.5 * 2.5 * std::sin(std::numbers::pi / 6) * 3, 1e-12);
}

/// The outward areas of a closed boundary sum to zero, and its flux of x is three volumes.
TEST(GridBody, HasAClosedOutwardBoundary) {
  const Body body = sector();
  Vec3 sum{};
  double flux = 0;
  for (const Triangle& t : body.boundary) {
    const Vec3 &x = body.nodes[to_index(t[0])], &y = body.nodes[to_index(t[1])],
               &z = body.nodes[to_index(t[2])];
    const Vec3 a = minus(y, x), b = minus(z, x);
    const Vec3 area{0.5 * (a[1] * b[2] - a[2] * b[1]), 0.5 * (a[2] * b[0] - a[0] * b[2]),
                    0.5 * (a[0] * b[1] - a[1] * b[0])};
    for (std::size_t i = 0; i < 3; ++i) sum[i] += area[i];
    flux += dot(area, x);
  }
  EXPECT_LT(norm(sum), 1e-12);
  EXPECT_NEAR(flux, 3 * 0.5 * 2.5 * 2.5 * std::sin(std::numbers::pi / 6) * 3, 1e-12);
}

TEST(GridBody, SupportsWhatLiesOnPlanes) {
  Body body = sector();
  fix_where(body, [](const Vec3& x) { return x[2] == 0; });
  slide_where(
      body, [](const Vec3& x) { return x[1] == 0; }, 7);
  EXPECT_EQ(body.fixed_nodes.size(), 5U);
  double area = 0;
  for (const SprungFacet& facet : body.foundation) {
    EXPECT_EQ(facet.normal_stiffness, 7);
    EXPECT_EQ(facet.tangential_stiffness, 0);
    const Triangle& t = body.boundary[to_index(facet.facet)];
    const Vec3 a = minus(body.nodes[to_index(t[1])], body.nodes[to_index(t[0])]),
               b = minus(body.nodes[to_index(t[2])], body.nodes[to_index(t[0])]);
    area += 0.5 * std::abs(a[0] * b[2] - a[2] * b[0]);
  }
  EXPECT_NEAR(area, 2.5 * 3, 1e-12);
}

TEST(GradedCells, AreFineUpToTheCoreAndGrowBeyond) {
  const std::vector<double> at = graded_cells(10, 2, 0.5, 1.5);
  ASSERT_GE(at.size(), 7U);
  EXPECT_EQ(at.front(), 0);
  EXPECT_NEAR(at.back(), 10, 1e-12);
  EXPECT_NEAR(at[4], 2, 1e-12);
  for (std::size_t i = 6; i < at.size(); ++i)
    EXPECT_NEAR((at[i] - at[i - 1]) / (at[i - 1] - at[i - 2]), 1.5, 1e-9);
  EXPECT_EQ(graded_cells(1, 2, 0.5, 1.5).size(), 3U);
}

}  // namespace
}  // namespace palpate::fem
