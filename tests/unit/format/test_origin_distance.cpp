// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/origin_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

TEST(OriginToSegment, IsTheFootOrTheNearerEnd) {
  EXPECT_DOUBLE_EQ(origin_to_segment({-1, 2, 0}, {3, 2, 0}), 2);
  EXPECT_DOUBLE_EQ(origin_to_segment({3, 4, 0}, {6, 8, 0}), 5);
  EXPECT_DOUBLE_EQ(origin_to_segment({0, 3, 4}, {0, 3, 4}), 5);
}

TEST(OriginToTriangle, IsTheFootInsideAndAnEdgeOutside) {
  EXPECT_DOUBLE_EQ(origin_to_triangle({-1, -1, 2}, {2, -1, 2}, {-1, 2, 2}), 2);
  EXPECT_DOUBLE_EQ(origin_to_triangle({1, -1, 2}, {1, 1, 2}, {3, 0, 2}), std::sqrt(5.0));
}

TEST(OriginToTriangle, DoesNotDependOnTheOrderOfTheCorners) {
  const Vec3 a{0.3, -1, 2}, b{2, -0.4, 1}, c{-1, 2, 1.5};
  const double distance = origin_to_triangle(a, b, c);
  for (const auto& [p, q, r] : {std::array{b, c, a}, std::array{c, a, b}, std::array{b, a, c},
                                std::array{a, c, b}, std::array{c, b, a}})
    EXPECT_NEAR(origin_to_triangle(p, q, r), distance, 1e-15);
}

TEST(OriginToTriangle, OfAFlatTriangleIsThatOfItsEdges) {
  EXPECT_DOUBLE_EQ(origin_to_triangle({-1, 3, 0}, {1, 3, 0}, {5, 3, 0}), 3);
}

}  // namespace
}  // namespace palpate
