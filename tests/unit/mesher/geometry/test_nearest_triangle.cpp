// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/geometry/nearest_triangle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "format/to_index.hpp"

namespace palpate::mesher {
namespace {

Surface random_triangles(std::size_t count, std::mt19937& random) {
  std::uniform_real_distribution<double> place(-1, 1), size(-0.2, 0.2);
  Surface surface;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 x{place(random), place(random), place(random)};
    const auto first = static_cast<std::int32_t>(surface.points.size());
    for (int k = 0; k < 3; ++k)
      surface.points.push_back(x + Vec3{size(random), size(random), size(random)});
    surface.triangles.push_back({first, first + 1, first + 2});
  }
  return surface;
}

TEST(NearestTriangle, IsThatOfTheSearchThroughAll) {
  std::mt19937 random(3);
  const Surface surface = random_triangles(300, random);
  const NearestTriangle nearest(surface);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  for (int i = 0; i < 500; ++i) {
    const Vec3 x{place(random), place(random), place(random)};
    double smallest = std::numeric_limits<double>::infinity();
    const auto distance = [&](const Triangle& t) {
      return distance_to_triangle(x, surface.points[to_index(t[0])], surface.points[to_index(t[1])],
                                  surface.points[to_index(t[2])]);
    };
    for (const Triangle& t : surface.triangles) smallest = std::min(smallest, distance(t));
    const auto found = nearest.to(x);
    EXPECT_EQ(found.distance, smallest);
    EXPECT_EQ(distance(surface.triangles[to_index(found.triangle)]), smallest);
  }
}

TEST(NearestTriangle, ItsCornersHaveNoDistance) {
  std::mt19937 random(4);
  const Surface surface = random_triangles(50, random);
  const NearestTriangle nearest(surface);
  for (const Vec3& x : surface.points) EXPECT_LT(nearest.to(x).distance, 1e-15);
}

TEST(NearestTriangle, OfOneTriangleIsThatOneAlsoWhereItHasNoArea) {
  Surface line;
  line.points = {{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}};
  line.triangles = {{0, 1, 2}};
  const auto found = NearestTriangle(line).to({0.25, 3, 4});
  EXPECT_EQ(found.triangle, 0);
  EXPECT_NEAR(found.distance, 5, 1e-15);
}

}  // namespace
}  // namespace palpate::mesher
