// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/skin/smooth.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "format/edge.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/queries.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

using std::numbers::pi;
using testing::HasSubstr;

constexpr double kRadius = 0.03;

Surface smoothed(const Surface& surface, double longest) {
  return smooth(surface, {pi / 4, 0.002, longest}, "shape");
}

/// Largest distance of points and middles of edges from the sphere of radius kRadius about 0.
double distance_from_ball(const Surface& surface) {
  double largest = 0;
  for (const Edge& edge : edges_of(surface.triangles)) {
    const Vec3 a = surface.points[to_index(edge[0])], b = surface.points[to_index(edge[1])];
    for (const Vec3& x : {a, b, 0.5 * (a + b)})
      largest = std::max(largest, std::abs(norm(x) - kRadius));
  }
  return largest;
}

/// The largest angle between neighbouring facets, rad.
double largest_bend(const Surface& surface) {
  double least = 1;
  const auto sides = incident_triangles(surface.points.size(), surface.triangles);
  for (const Edge& edge : edges_of(surface.triangles)) {
    std::vector<Vec3> normals;
    for (const std::int32_t t : sides[to_index(edge[0])]) {
      const Triangle& corners = surface.triangles[to_index(t)];
      if (std::find(corners.begin(), corners.end(), edge[1]) != corners.end())
        normals.push_back(unit(area_vector(surface.points, corners)));
    }
    least = std::min(least, dot(normals.at(0), normals.at(1)));
  }
  return std::acos(std::min(1.0, least));
}

TEST(Smooth, ABallOfFacetsIsRound) {
  const Surface facets = test::sphere({0, 0, 0}, kRadius, 24);
  const Surface ball = smoothed(facets, 0.001);
  EXPECT_GT(distance_from_ball(facets), 0.008 * kRadius);
  EXPECT_LT(distance_from_ball(ball), 0.001 * kRadius);
  EXPECT_LT(largest_bend(ball), 0.3 * largest_bend(facets));
  const double volume = 4 * pi / 3 * std::pow(kRadius, 3);
  EXPECT_LT(signed_volume(facets), 0.98 * volume);
  EXPECT_NEAR(signed_volume(ball), volume, 0.001 * volume);
  EXPECT_EQ(count_self_intersections(ball), 0);
  // The points of the file stay where they are.
  ASSERT_GT(ball.points.size(), facets.points.size());
  EXPECT_TRUE(std::equal(facets.points.begin(), facets.points.end(), ball.points.begin()));
}

/// The cubic of an edge leaves a circle by the fourth power of its length.
TEST(Smooth, ErrsByTheFourthPowerOfTheFacets) {
  const auto error = [](int meridians) {
    const Surface facets = test::sphere({0, 0, 0}, kRadius, meridians);
    const Surface ball = smoothed(facets, 0.3e-3);
    double largest = 0;
    for (const Vec3& x : ball.points) largest = std::max(largest, std::abs(norm(x) - kRadius));
    return largest;
  };
  EXPECT_GT(error(12) / error(24), 8);
}

/// Circles of a rim are curved along themselves, its caps stay flat.
TEST(Smooth, ACylinderKeepsItsRims) {
  constexpr double kLength = 0.05;
  const Surface facets = test::cylinder(kRadius, kLength, 16);
  const Surface cylinder = smoothed(facets, 0.002);
  double outermost = 0, innermost = kRadius;
  for (const Vec3& x : cylinder.points) {
    EXPECT_GE(x[2], -1e-15);
    EXPECT_LE(x[2], kLength + 1e-15);
    const bool on_cap = x[2] < 1e-12 || x[2] > kLength - 1e-12;
    const double r = std::hypot(x[0], x[1]);
    outermost = std::max(outermost, r);
    if (!on_cap) innermost = std::min(innermost, r);
  }
  EXPECT_LT(outermost, 1.001 * kRadius);
  EXPECT_GT(innermost, 0.999 * kRadius);
  const double volume = pi * kRadius * kRadius * kLength;
  EXPECT_LT(signed_volume(facets), 0.98 * volume);
  EXPECT_NEAR(signed_volume(cylinder), volume, 0.001 * volume);
}

TEST(Smooth, FlatFacetsStayAsTheyAre) {
  const Surface box = test::box({0, 0, 0}, {0.05, 0.04, 0.03});
  const Surface same = smoothed(box, 0.001);
  EXPECT_EQ(same.points, box.points);
  EXPECT_EQ(same.triangles, box.triangles);
}

/// A cylinder one half of which is stretched to a half ellipse: straight edges are halved where
/// those beside them are curved, so that no triangle becomes a sliver and the halving ends.
TEST(Smooth, HalvesStraightEdgesBesideCurvedOnes) {
  Surface s = test::cylinder(0.01, 0.06, 12);
  for (Vec3& x : s.points)
    if (x[0] < 0) x[0] *= 5;
  const Surface nose = smoothed(s, 0.002);
  EXPECT_LT(nose.triangles.size(), 30000U);
  EXPECT_EQ(count_degenerate_triangles(nose), 0);
  double longest = 0;
  for (const Edge& edge : edges_of(nose.triangles)) {
    const Vec3 d = nose.points[to_index(edge[1])] - nose.points[to_index(edge[0])];
    if (std::abs(d[2]) < 1e-6) continue;  // on the flat caps
    longest = std::max(longest, norm(d));
  }
  EXPECT_LT(longest, 0.006);
}

TEST(Smooth, PartsOfAFaceHaveItsNames) {
  Surface facets = test::sphere({0, 0, 0}, kRadius, 24);
  facets.known_names = {{"south"}, {"north"}};
  for (const Triangle& t : facets.triangles) {
    double height = 0;
    for (const std::int32_t v : t) height += facets.points[to_index(v)][2];
    facets.names.push_back(height > 0 ? 1 : 0);
  }
  const Surface ball = smoothed(facets, 0.002);
  ASSERT_EQ(ball.names.size(), ball.triangles.size());
  for (std::size_t t = 0; t < ball.triangles.size(); ++t)
    for (const std::int32_t v : ball.triangles[t])
      EXPECT_GE((ball.names[t] == 1 ? 1 : -1) * ball.points[to_index(v)][2], -1e-9);
}

/// The facets of two octahedra are flat and do not meet; the balls through their corners do.
TEST(Smooth, WhatSelfIntersectsWhenSmoothIsRefused) {
  const Surface octahedron{
      {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}},
      {},
      {}};
  Surface two = octahedron, other = octahedron;
  for (Vec3& x : other.points) x = x + Vec3{0.75, 0.75, 0.75};
  append(two, other);
  ASSERT_EQ(count_self_intersections(two), 0);
  try {
    smooth(two, {2, 0.1, 0.3}, "twins");
    ADD_FAILURE() << "twins that cross";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
    EXPECT_THAT(error.problem(), HasSubstr("self-intersects"));
    EXPECT_THAT(error.remedy(), HasSubstr("surface.smooth = false"));
  }
}

}  // namespace
}  // namespace palpate::mesher
