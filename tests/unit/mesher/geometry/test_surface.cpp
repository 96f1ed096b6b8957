// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "mesher/geometry/surface.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

TEST(Surface, BoxHasItsBoundsAreaAndVolume) {
  const Surface box = test::box({-1, 0, 2}, {1, 3, 3});
  EXPECT_EQ(bounds(box.points).low, (Vec3{-1, 0, 2}));
  EXPECT_EQ(bounds(box.points).high, (Vec3{1, 3, 3}));
  EXPECT_EQ(largest_dimension(box.points), 3);
  EXPECT_NEAR(area(box), 2 * (2 * 3 + 3 * 1 + 1 * 2), 1e-12);
  EXPECT_NEAR(signed_volume(box), 6, 1e-12);
  EXPECT_EQ(extent_of(box.points), "(-1000, 0, 2000) mm to (1000, 3000, 3000) mm");
}

TEST(Surface, VolumeIsSignedAndKeepsItsDigitsFarFromTheOrigin) {
  Surface box = test::box({1e6, 1e6, 1e6}, {1e6 + 1, 1e6 + 1, 1e6 + 1});
  EXPECT_NEAR(signed_volume(box), 1, 1e-12);
  for (Triangle& t : box.triangles) std::swap(t[0], t[1]);
  EXPECT_NEAR(signed_volume(box), -1, 1e-12);
}

TEST(Surface, MeanThicknessOfAPlateIsItsThicknessButForTheRim) {
  // 2 V / A of a x a x t is t / (1 + 2 t / a).
  EXPECT_NEAR(mean_thickness(test::box({0, 0, 0}, {0.1, 0.1, 0.001})), 0.001 / 1.02, 1e-12);
  EXPECT_EQ(mean_thickness({}), 0);
}

TEST(Surface, AppendShiftsTheIndices) {
  Surface both = test::box({0, 0, 0}, {1, 1, 1});
  append(both, test::box({2, 0, 0}, {3, 1, 1}));
  EXPECT_EQ(both.points.size(), 16U);
  EXPECT_EQ(both.triangles.size(), 24U);
  EXPECT_NEAR(signed_volume(both), 2, 1e-12);
  const auto around = incident_triangles(both.points.size(), both.triangles);
  for (const std::int32_t t : around[8]) EXPECT_GE(t, 12);
}

TEST(Surface, DistanceToATriangleIsThatToItsFaceEdgeOrCorner) {
  const Vec3 a{0, 0, 0}, b{2, 0, 0}, c{0, 2, 0};
  EXPECT_NEAR(distance_to_triangle({0.5, 0.5, -3}, a, b, c), 3, 1e-15);
  EXPECT_NEAR(distance_to_triangle({1, -1, 0}, a, b, c), 1, 1e-15);
  EXPECT_NEAR(distance_to_triangle({2, 2, 0}, a, b, c), std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(distance_to_triangle({5, -4, 0}, a, b, c), 5, 1e-15);
  EXPECT_NEAR(distance_to_triangle({3, 1, 0}, a, a, a), std::sqrt(10.0), 1e-15);
}

}  // namespace
}  // namespace palpate::mesher
