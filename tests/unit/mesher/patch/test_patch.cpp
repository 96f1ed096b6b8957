// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/patch/patch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "format/edge.hpp"
#include "format/to_index.hpp"
#include "tests/unit/format/refusal.hpp"

namespace palpate::mesher {
namespace {

using samples::expect_refusal;

constexpr double kSpacing = 0.005;

/// A point of the paraboloid z = -(x^2 + y^2)/(2 R), R = 60 mm, with its normal.
ContactPoint on_dome(const std::string& name, double x, double y) {
  constexpr double radius = 0.06;
  const Vec3 normal{x / radius, y / radius, 1};
  return {name, {x, y, -(x * x + y * y) / (2 * radius)}, (1 / norm(normal)) * normal};
}

/// 6 x 5 sites whose places are a tenth of the spacing off a grid.
std::vector<ContactPoint> dome() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> off(-0.1 * kSpacing, 0.1 * kSpacing);
  std::vector<ContactPoint> points;
  for (int i = 0; i < 30; ++i) {
    points.push_back(on_dome("site " + std::to_string(i), (i % 6) * kSpacing + off(random),
                             (i / 6) * kSpacing + off(random)));
  }
  return points;
}

double area_of(const std::vector<ContactPoint>& points, const Patch& patch) {
  double area = 0;
  for (const Triangle& t : patch.triangles) {
    const Vec3 a = points[to_index(t[0])].position;
    const Vec3 twice =
        cross(points[to_index(t[1])].position - a, points[to_index(t[2])].position - a);
    EXPECT_GT(dot(twice, patch.mean_normal), 0) << "wound the wrong way";
    area += 0.5 * dot(twice, patch.mean_normal);
  }
  return area;
}

void expect_patch_refused(const std::vector<ContactPoint>& points, const std::string& problem) {
  expect_refusal([&] { make_patch(points, "robot.csv"); }, ErrorKind::Configuration, "robot.csv",
                 problem);
}

TEST(MeasuredPatch, IsADiscOverAllSitesAndSeesOutwards) {
  const std::vector<ContactPoint> points = dome();
  const Patch patch = make_patch(points, "robot.csv");
  // Euler's characteristic of a disc, and every site has a triangle.
  const std::vector<Edge> edges = edges_of(patch.triangles);
  EXPECT_EQ(30 - static_cast<int>(edges.size()) + static_cast<int>(patch.triangles.size()), 1);
  std::vector<int> seen(points.size(), 0);
  for (const Triangle& t : patch.triangles)
    for (const std::int32_t corner : t) seen[to_index(corner)] = 1;
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], 1) << i;
  // The grid covers 25 by 20 mm; sites off it change that by a tenth of a spacing at each side.
  EXPECT_NEAR(area_of(points, patch), 500e-6, 0.1 * 500e-6);
  EXPECT_NEAR(patch.spacing, kSpacing, 0.2 * kSpacing);
  EXPECT_TRUE(patch.warnings.empty());
}

TEST(MeasuredPatch, IsTheSameInAnyFrame) {
  std::vector<ContactPoint> points = dome();
  const Patch patch = make_patch(points, "robot.csv");
  const double turn = 2.2;
  for (ContactPoint& p : points) {
    const auto rotated = [&](const Vec3& v) {
      return Vec3{v[2], std::cos(turn) * v[0] - std::sin(turn) * v[1],
                  std::sin(turn) * v[0] + std::cos(turn) * v[1]};
    };
    p.position = rotated(p.position) + Vec3{1, -2, 3};
    p.outward = rotated(p.outward);
  }
  const Patch turned = make_patch(points, "robot.csv");
  EXPECT_EQ(edges_of(turned.triangles), edges_of(patch.triangles));
  EXPECT_NEAR(turned.steepest, patch.steepest, 1e-9);
}

TEST(MeasuredPatch, FindsThePlaceBelowAPosition) {
  const std::vector<ContactPoint> points = dome();
  const Patch patch = make_patch(points, "robot.csv");
  const Vec3 natural{0.2, 0.5, 0.3};
  for (std::size_t t = 0; t < patch.triangles.size(); ++t) {
    Vec3 x = 0.004 * patch.mean_normal;
    for (std::size_t i = 0; i < 3; ++i)
      x = x + natural[i] * points[to_index(patch.triangles[t][i])].position;
    const auto place = place_on(patch, points, x);
    ASSERT_TRUE(place.has_value()) << t;
    EXPECT_EQ(place->triangle, t);
    EXPECT_LT(norm(place->natural - natural), 1e-9);
  }
  EXPECT_FALSE(place_on(patch, points, {-0.01, 0.01, 0}).has_value());
}

TEST(MeasuredPatch, FollowsAConcaveOutline) {
  // An L of spacing 5 mm: the hull would span the corner that nobody touched.
  std::vector<ContactPoint> points;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) {
      if (i > 2 && j > 2) continue;
      points.push_back(
          on_dome("site " + std::to_string(points.size()), i * kSpacing, j * kSpacing));
    }
  }
  const Patch patch = make_patch(points, "robot.csv");
  // The L has 24 squares of 25 mm^2; the hull adds a triangle of 25 mm by 25 mm over two.
  EXPECT_NEAR(area_of(points, patch), 24 * 25e-6, 4 * 25e-6);
}

/// Points of a straight border bulge by nothing: the hull closes them with triangles of no height,
/// which look anywhere.
TEST(MeasuredPatch, HasNoSliversAlongAStraightBorder) {
  std::vector<ContactPoint> points;
  for (int i = 0; i < 63; ++i) {
    const double x = kSpacing * (i % 9 - 4), y = kSpacing * (i / 9 - 3);
    points.push_back(on_dome("site " + std::to_string(i), x + 0.12 * y, y - 0.15 * x));
  }
  const Patch patch = make_patch(points, "robot.csv");
  EXPECT_LT(patch.largest_turn, 0.3);
  for (const Triangle& t : patch.triangles) {
    const auto at = [&](std::size_t i) { return points[to_index(t[i])].position; };
    EXPECT_GT(norm(cross(at(1) - at(0), at(2) - at(0))), 0.3 * kSpacing * kSpacing);
  }
}

TEST(MeasuredPatch, NamesASiteOffTheSurface) {
  std::vector<ContactPoint> points = dome();
  points[14].position[2] += 0.3 * kSpacing;
  const Patch patch = make_patch(points, "robot.csv");
  ASSERT_FALSE(patch.warnings.empty());
  EXPECT_NE(patch.warnings.front().find("site 14 at"), std::string::npos) << patch.warnings.front();
  // 1.5 mm along z, which is some 15 degrees off the mean normal.
  EXPECT_NE(patch.warnings.front().find("1.4"), std::string::npos) << patch.warnings.front();
  EXPECT_EQ(patch.warnings.size(), 1U);
}

TEST(MeasuredPatch, RefusesTwoSitesAtOnePlace) {
  std::vector<ContactPoint> points = dome();
  points.push_back(on_dome("site 30", points[7].position[0] + 1e-5, points[7].position[1]));
  expect_patch_refused(points, "site 7 and site 30");
}

TEST(MeasuredPatch, RefusesSitesOnALine) {
  std::vector<ContactPoint> points;
  for (int i = 0; i < 9; ++i)
    points.push_back(on_dome("site " + std::to_string(i), i * kSpacing, 2 * i * kSpacing));
  expect_patch_refused(points, "on one line");
  points.resize(2);
  expect_patch_refused(points, "2 contact points");
}

TEST(MeasuredPatch, RefusesNormalsThatOppose) {
  std::vector<ContactPoint> points = dome();
  points[11].outward = -points[11].outward;
  expect_patch_refused(points, "site 11");
  points[11].outward = {1, 0, 0.2};
  expect_patch_refused(points, "not 1");
}

TEST(MeasuredPatch, RefusesABallWhoseSidesAreNoHeightField) {
  std::vector<ContactPoint> points;
  for (int i = 0; i < 60; ++i) {
    const double z = 1 - (i + 0.5) / 30, turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const double r = std::sqrt(1 - z * z);
    const Vec3 out{r * std::cos(turn), r * std::sin(turn), z};
    points.push_back({"site " + std::to_string(i), 0.03 * out, out});
  }
  expect_patch_refused(points, "height field");
}

TEST(MeasuredPatch, RefusesWhatIsNotFinite) {
  std::vector<ContactPoint> points = dome();
  points[5].position[1] = std::numeric_limits<double>::quiet_NaN();
  expect_patch_refused(points, "site 5");
}

TEST(MeasuredPatch, RefusesASiteFarFromAllOthers) {
  std::vector<ContactPoint> points = dome();
  points.push_back(on_dome("site 30", 0.06, 0.01));
  expect_patch_refused(points, "site 30");
}

}  // namespace
}  // namespace palpate::mesher
