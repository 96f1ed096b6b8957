// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/inclusions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::report {
namespace {

constexpr double kCell = 0.01;  // m

/// A block of 4 x 4 x 4 cells; the tetrahedra with their centroids in the box are region 1.
Body block_with(const Vec3& low, const Vec3& high) {
  const std::vector<double> grid = test::even(0, 4 * kCell, 4);
  Body body = test::make_block(grid, grid, grid);
  body.region_names = {"tissue", "nodule"};
  for (std::size_t t = 0; t < body.tetrahedra.size(); ++t) {
    Vec3 centroid{};
    for (const std::int32_t n : body.tetrahedra[t])
      centroid = centroid + 0.25 * body.nodes[to_index(n)];
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k)
      inside = inside && centroid[k] > low[k] && centroid[k] < high[k];
    body.tetrahedron_region[t] = inside ? 1 : 0;
  }
  return body;
}

/// The divergence theorem: the flux of x/3 through a closed, outward surface is its volume.
TEST(Inclusions, HaveTheClosedOutwardSurfaceOfTheirRegion) {
  const Body body = block_with({kCell, kCell, kCell}, {3 * kCell, 3 * kCell, 2 * kCell});
  const std::vector<Inclusion> found = inclusions(body);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].region, 1);
  double volume = 0, area = 0;
  Vec3 total{};
  for (const Triangle& f : found[0].facets) {
    const auto x = [&](std::size_t i) {
      return body.nodes[to_index(found[0].node[to_index(f[i])])];
    };
    const Vec3 normal = 0.5 * cross(x(1) - x(0), x(2) - x(0));
    volume += dot(x(0), normal) / 3;
    area += norm(normal);
    total = total + normal;
  }
  EXPECT_NEAR(volume, 4 * std::pow(kCell, 3), 1e-15);
  EXPECT_NEAR(area, (2 * 4 + 4 * 2) * kCell * kCell, 1e-12);
  EXPECT_NEAR(norm(total), 0, 1e-15);
  const std::set<std::int32_t> nodes(found[0].node.begin(), found[0].node.end());
  EXPECT_EQ(nodes.size(), found[0].node.size());
}

TEST(Inclusions, DoNotReachTheBoundary) {
  EXPECT_TRUE(inclusions(block_with({0, kCell, kCell}, {2 * kCell, 3 * kCell, 3 * kCell})).empty());
}

TEST(Inclusions, OfOneRegionAreNone) {
  EXPECT_TRUE(inclusions(block_with({0, 0, 0}, {0, 0, 0})).empty());
}

}  // namespace
}  // namespace palpate::report
