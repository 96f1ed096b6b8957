// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/response/slide_directions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace palpate::mesher {
namespace {

using Three = std::array<Vec3, 3>;

const Three kFlat{{{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}}};

/// A cube of n x n squares on each side, whose corners are 0 and `length`.
Surface fine_cube(double length, int n) {
  Surface cube;
  std::map<std::array<int, 3>, std::int32_t> known;
  const auto corner = [&](const std::array<int, 3>& at) {
    const auto [entry, is_new] =
        known.try_emplace(at, static_cast<std::int32_t>(cube.points.size()));
    const double h = length / n;
    if (is_new) cube.points.push_back({h * at[0], h * at[1], h * at[2]});
    return entry->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int side : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          std::array<std::int32_t, 4> v{};
          for (std::size_t k = 0; k < 4; ++k) {
            std::array<int, 3> at{};
            at[axis] = side;
            at[(axis + 1) % 3] = i + (k == 1 || k == 2 ? 1 : 0);
            at[(axis + 2) % 3] = j + (k >= 2 ? 1 : 0);
            v[k] = corner(at);
          }
          if (side == 0) std::swap(v[1], v[3]);
          cube.triangles.push_back({v[0], v[1], v[2]});
          cube.triangles.push_back({v[0], v[2], v[3]});
        }
  return cube;
}

std::vector<Vec3> mean_inward(const Surface& surface) {
  std::vector<Vec3> mean(surface.points.size());
  for (const Triangle& t : surface.triangles)
    for (const std::int32_t v : t)
      mean[static_cast<std::size_t>(v)] =
          mean[static_cast<std::size_t>(v)] - unit(area_vector(surface.points, t));
  for (Vec3& n : mean) n = unit(n);
  return mean;
}

bool anything(std::size_t, const Three&) {
  return true;
}

// t . tau = 1 and n . tau = 0 on a flat facet pressed along its normal.
TEST(SlideRate, OfAFlatFacetIsOne) {
  const Vec3 in{0, 0, -1};
  EXPECT_NEAR(slide_rate(kFlat, {in, in, in}, {.depth = 0.005, .lift = 0.5}), 1, 1e-12);
}

// Equal directions that lean by theta along x: the slide towards x has t . tau = cos theta and
// n . tau = sin theta.
TEST(SlideRate, OfALeaningDirectionIsTheCosineLessTheLift) {
  const double theta = 0.4, m = 0.5;
  const Vec3 in{std::sin(theta), 0, -std::cos(theta)};
  EXPECT_NEAR(slide_rate(kFlat, {in, in, in}, {.depth = 0.005, .lift = m}),
              std::cos(theta) - m * std::sin(theta), 1e-12);
}

// Directions towards the centre of a sphere of radius R turn by 1/R: 1 - D/R of the motion is left
// at the middle of a small facet, and lifting turns the direction of a drag by m rho/R.
TEST(SlideRate, FallsWithTheDepthOverTheRadius) {
  const double R = 1, D = 0.2, m = 0.5, a = 1e-3;
  Three points, inward;
  for (std::size_t k = 0; k < 3; ++k) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(k) / 3;
    points[k] = unit(Vec3{a * std::cos(angle), a * std::sin(angle), R});
    inward[k] = -points[k];
  }
  EXPECT_NEAR(slide_rate(points, inward, {.depth = D, .lift = m}), 1 - D / R - m * m * D / R,
              2 * a);
}

// A cube has edges of 90 degrees, whose mean normals lean by 45 degrees and its corners by 55.
TEST(SlideDirections, OfACubeSlideEverywhere) {
  const Surface cube = fine_cube(0.05, 5);
  const std::vector<Vec3> mean = mean_inward(cube);
  const SlideDemand demand{.depth = 0.0025, .lift = 0.5};
  const std::vector<bool> free(mean.size(), true);
  const SlideDirections turned = slide_directions(cube, mean, free, demand, anything);
  EXPECT_GT(turned.unbounded, 10U);
  EXPECT_EQ(turned.still_unbounded, 0U);
  for (const Triangle& t : cube.triangles) {
    const auto at = [&](std::size_t k) { return static_cast<std::size_t>(t[k]); };
    EXPECT_GT(
        slide_rate({cube.points[at(0)], cube.points[at(1)], cube.points[at(2)]},
                   {turned.inward[at(0)], turned.inward[at(1)], turned.inward[at(2)]}, demand),
        0);
  }
}

// Pressed deeper, at two fifths of a patch, the corners keep triangles without a bound, and no tool
// is pressed more obliquely than is said.
TEST(SlideDirections, TurnNoFartherThanTheyMay) {
  const Surface cube = fine_cube(0.05, 5);
  const std::vector<Vec3> mean = mean_inward(cube);
  const SlideDirections turned = slide_directions(cube, mean, std::vector<bool>(mean.size(), true),
                                                  {.depth = 0.004}, anything);
  EXPECT_GT(turned.unbounded, 100U);
  EXPECT_GT(turned.still_unbounded, 0U);
  EXPECT_LT(turned.still_unbounded, turned.unbounded / 5);
  double least = 1;
  for (std::size_t v = 0; v < mean.size(); ++v)
    least = std::min(least, dot(mean[v], turned.inward[v]));
  EXPECT_GT(std::acos(least), 30 * std::numbers::pi / 180);
  EXPECT_LE(std::acos(least), 0.6 + 1e-9);
}

TEST(SlideDirections, StayWhereSlidesHaveABoundAndWhereVerticesAreNotFree) {
  const Surface cube = fine_cube(0.05, 5);
  std::vector<Vec3> centre;
  for (const Vec3& x : cube.points) centre.push_back(unit(Vec3{0.025, 0.025, 0.025} - x));
  const SlideDemand shallow{.depth = 1e-5, .lift = 0.1};
  const SlideDirections same =
      slide_directions(cube, centre, std::vector<bool>(centre.size(), true), shallow, anything);
  EXPECT_EQ(same.unbounded, 0U);
  const SlideDemand deep{.depth = 0.01, .lift = 0.6};
  const SlideDirections fixed =
      slide_directions(cube, centre, std::vector<bool>(centre.size(), false), deep, anything);
  for (std::size_t v = 0; v < centre.size(); ++v) {
    EXPECT_EQ(norm(same.inward[v] - centre[v]), 0);
    EXPECT_EQ(norm(fixed.inward[v] - centre[v]), 0);
  }
}

}  // namespace
}  // namespace palpate::mesher
