// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/triangle_cloud.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palpate::mesher {
namespace {

/// Two parallel triangles, and one across them.
const std::vector<Vec3> kPoints{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                                {1, 0, 1}, {0, 1, 1}, {5, 5, 5}};
const std::vector<Triangle> kTriangles{{0, 1, 2}, {3, 4, 5}};

TEST(TriangleCloud, ClosestLiesOnASideAnEdgeOrACorner) {
  const TriangleCloud cloud(kPoints, kTriangles);
  const auto expect = [&](const Vec3& x, const Vec3& closest) {
    const Vec3 found = cloud.closest(x);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], closest[k], 1e-14);
  };
  expect({0.2, 0.2, 0.3}, {0.2, 0.2, 0});
  expect({0.2, 0.2, 0.7}, {0.2, 0.2, 1});
  expect({1, 1, -1}, {0.5, 0.5, 0});
  expect({-1, -1, 2}, {0, 0, 1});
  expect({4, 4, 4}, {0.5, 0.5, 1});  // points of no triangle do not count
}

TEST(TriangleCloud, HitsAreTheFractionsOfASegment) {
  const TriangleCloud cloud(kPoints, kTriangles);
  const auto hits = cloud.hits({0.2, 0.2, -1}, {0.2, 0.2, 3});
  ASSERT_EQ(hits.size(), 2U);
  EXPECT_NEAR(hits[0], 0.25, 1e-14);
  EXPECT_NEAR(hits[1], 0.5, 1e-14);
  EXPECT_THAT(cloud.hits({0.2, 0.2, 3}, {0.2, 0.2, -1}),
              testing::SizeIs(2));  // from the other side
  EXPECT_TRUE(cloud.hits({0.2, 0.2, 0.1}, {0.2, 0.2, 0.9}).empty());
  EXPECT_TRUE(cloud.hits({0.8, 0.8, -1}, {0.8, 0.8, 3}).empty());
}

}  // namespace
}  // namespace palpate::mesher
