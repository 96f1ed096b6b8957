// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/sheets.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "tests/unit/mesher/repair/soups.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

using testing::Contains;
using testing::HasSubstr;

Surface cube(const Vec3& low) {
  return test::box(low, low + Vec3{0.05, 0.05, 0.05});
}

/// Whether every edge has two triangles that run along it in opposite directions.
bool is_closed(const Surface& surface) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> balance, sides;
  for (const Triangle& t : surface.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = t[k], b = t[(k + 1) % 3];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
      ++sides[std::minmax(a, b)];
    }
  }
  for (const auto& [edge, count] : sides)
    if (count != 2 || balance[edge] != 0) return false;
  return true;
}

TEST(DuplicateFaces, OfEitherOrientationLeaveOne) {
  Soup soup = test::soup_of(cube({0, 0, 0}));
  auto turned = soup.polygons[3];
  std::reverse(turned.begin(), turned.end());
  soup.polygons.push_back(soup.polygons[5]);
  soup.polygons.push_back(turned);
  Steps steps;
  remove_duplicate_faces(soup, steps);
  EXPECT_EQ(soup.polygons.size(), 12U);
  EXPECT_THAT(steps, Contains("removed 2 duplicate or collapsed faces"));
}

TEST(Sheets, WithTurnedFacesEncloseTheirVolume) {
  Soup soup = test::soup_of(cube({0, 0, 0}));
  for (std::size_t p = 0; p < soup.polygons.size(); p += 2)
    std::swap(soup.polygons[p][0], soup.polygons[p][1]);
  Steps steps;
  const Surface surface = connect(soup, steps).surface;
  EXPECT_TRUE(is_closed(surface));
  EXPECT_NEAR(std::abs(signed_volume(surface)), 0.05 * 0.05 * 0.05, 1e-18);
}

TEST(Sheets, AreSeparatedOnlyWhereTheyMeet) {
  Steps steps;
  EXPECT_FALSE(connect(test::soup_of(cube({0, 0, 0})), steps).separated);
}

TEST(Sheets, ThatMeetInAPointAreSeparated) {
  // Two cubes that share one corner.
  Soup soup = test::soup_of(test::joined(cube({0, 0, 0}), cube({0.05, 0.05, 0.05})));
  std::size_t first = 0, second = 0;
  for (std::size_t v = 0; v < soup.points.size(); ++v)
    if (norm(soup.points[v] - Vec3{0.05, 0.05, 0.05}) < 1e-12) (v < 8 ? first : second) = v;
  for (auto& corners : soup.polygons) std::replace(corners.begin(), corners.end(), second, first);
  Steps steps;
  const auto [surface, separated] = connect(soup, steps);
  EXPECT_TRUE(separated);
  std::set<std::int32_t> corners;
  for (const Triangle& t : surface.triangles) corners.insert(t.begin(), t.end());
  EXPECT_EQ(corners.size(), 16U);
  EXPECT_TRUE(is_closed(surface));
  EXPECT_THAT(steps, Contains(HasSubstr("1 point duplicated")));
}

TEST(Sheets, WhoseBordersCoincideAreStitched) {
  // The upper half of a ball has points of its own on the equator.
  const Surface ball = test::sphere({0, 0, 0}, 0.03, 16);
  const Surface lower = test::without(ball, [](const Vec3& x) { return x[2] > -1e-9; });
  const Surface upper = test::without(ball, [](const Vec3& x) { return x[2] < 1e-9; });
  ASSERT_LT(lower.triangles.size(), ball.triangles.size());
  Steps steps;
  const Surface surface = connect(test::soup_of(test::joined(lower, upper)), steps).surface;
  EXPECT_TRUE(is_closed(surface));
  EXPECT_THAT(steps, Contains("stitched 16 pairs of border edges"));
}

}  // namespace
}  // namespace palpate::mesher
