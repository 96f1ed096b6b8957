// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/points.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/unit/mesher/repair/soups.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kExtent = 0.05;  // m

Surface cube() {
  return test::box({0, 0, 0}, {kExtent, kExtent, kExtent});
}

std::size_t distinct_points(const Soup& soup) {
  std::set<std::size_t> used;
  for (const auto& corners : soup.polygons) used.insert(corners.begin(), corners.end());
  return used.size();
}

TEST(NearPoints, OfABoxWhoseFacesHaveCornersOfTheirOwnBecomeItsEightCorners) {
  Soup soup = test::unconnected(cube());
  for (std::size_t i = 0; i < soup.points.size(); ++i)
    soup.points[i][i % 3] += (i % 2 == 0 ? 1e-5 : -1e-5) * kExtent;
  Steps steps;
  merge_near_points(soup, kExtent, steps);
  EXPECT_EQ(distinct_points(soup), 8U);
  EXPECT_THAT(steps, ElementsAre(HasSubstr("merged 28 points less than")));  // 36 corners to 8
}

TEST(NearPoints, OfAClosedSurfaceStayAsTheyAre) {
  Soup soup = test::soup_of(cube());
  Steps steps;
  merge_near_points(soup, 1e6 * kExtent, steps);
  EXPECT_EQ(distinct_points(soup), 8U);
  EXPECT_TRUE(steps.empty());
}

TEST(NearPoints, AreNeverTheEndsOfAnEdge) {
  // The extent is that of a body ten thousand times as large: the triangles are noise of it.
  Soup soup = test::unconnected(cube());
  Steps steps;
  merge_near_points(soup, 1e4 * kExtent, steps);
  EXPECT_EQ(distinct_points(soup), 8U);
  for (const auto& corners : soup.polygons)
    EXPECT_EQ(std::set<std::size_t>(corners.begin(), corners.end()).size(), 3U);
}

TEST(TJunctions, OnOneEdgeBecomeCornersInTheirOrder) {
  // A square of one face beside three triangles that divide its side.
  Soup soup;
  soup.points = {{0, 0, 0}, {1, 0, 0}, {1, 3, 0}, {0, 3, 0}, {1, 2, 0}, {1, 1, 0}, {2, 0, 0}};
  soup.polygons = {{0, 1, 2, 3}, {1, 6, 5}, {5, 6, 4}, {4, 6, 2}};
  Steps steps;
  split_t_junctions(soup, 3, steps);
  EXPECT_THAT(soup.polygons[0], ElementsAre(0U, 1U, 5U, 4U, 2U, 3U));
  EXPECT_THAT(soup.polygons[1], ElementsAre(1U, 6U, 5U));
  EXPECT_THAT(steps, ElementsAre("split 2 T-junctions"));
}

TEST(TJunctions, AreNoPointsBesideAnEdge) {
  Soup soup;
  soup.points = {{0, 0, 0}, {1, 0, 0}, {1, 3, 0}, {1.01, 1, 0}, {2, 0, 0}, {2, 2, 0}};
  soup.polygons = {{0, 1, 2}, {3, 4, 5}};
  Steps steps;
  split_t_junctions(soup, 3, steps);
  EXPECT_THAT(soup.polygons[0], ElementsAre(0U, 1U, 2U));
  EXPECT_TRUE(steps.empty());
}

}  // namespace
}  // namespace palpate::mesher
