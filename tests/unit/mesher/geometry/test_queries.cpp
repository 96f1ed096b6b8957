// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include "mesher/geometry/queries.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

TEST(Queries, InsideOutsideAndRays) {
  const SurfaceQuery query(test::box({0, 0, 0}, {1, 2, 3}));
  EXPECT_TRUE(query.contains({0.5, 0.5, 2.999}));
  EXPECT_FALSE(query.contains({0.5, 0.5, 3.001}));
  EXPECT_FALSE(query.contains({0.5, 0.5, 3}));
  EXPECT_NEAR(query.first_hit({0.4, 0.3, 1}, {0, 0, 1}).value(), 2, 1e-14);
  EXPECT_FALSE(query.first_hit({0.4, 0.3, 4}, {0, 0, 1}).has_value());
  const Vec3 foot = query.closest({0.4, 0.3, 5}).point;
  EXPECT_NEAR(norm(foot - Vec3{0.4, 0.3, 3}), 0, 1e-14);
}

TEST(Queries, CountDegenerateTrianglesAndSelfIntersections) {
  Surface box = test::box({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(count_degenerate_triangles(box), 0U);
  EXPECT_EQ(count_self_intersections(box), 0U);
  box.points[0] = {2, 2, 2};  // through the opposite corner
  EXPECT_GT(count_self_intersections(box), 0U);
  Surface flat;
  flat.points = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}};
  flat.triangles = {{0, 1, 2}};
  EXPECT_EQ(count_degenerate_triangles(flat), 1U);
}

TEST(Queries, SurfacesMeetWhereTheyTouchOrCross) {
  const Surface box = test::box({0, 0, 0}, {1, 1, 1});
  EXPECT_TRUE(surfaces_meet(box, test::box({0.5, 0.5, 0.5}, {2, 2, 2})));
  EXPECT_TRUE(surfaces_meet(box, test::box({1, 0, 0}, {2, 1, 1})));
  EXPECT_FALSE(surfaces_meet(box, test::box({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8})));
}

}  // namespace
}  // namespace palpate::mesher
