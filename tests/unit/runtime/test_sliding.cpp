// SPDX-License-Identifier: AGPL-3.0-or-later
// Walking over the triangles: straight where the surface is flat, along great circles where it is a
// sphere, and stopped or led along where it ends.
#include "runtime/sliding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/bodies.hpp"

namespace palpate::test {
namespace {

using runtime::kNoElement;
using runtime::Surface;
using runtime::SurfacePoint;
using runtime::walk;
using runtime::Walk;

SurfacePoint random_point(const Surface& surface, std::mt19937& random) {
  std::uniform_real_distribution<double> any(0, 1);
  const Vec3 n{any(random), any(random), any(random)};
  const auto count = static_cast<unsigned>(surface.element_count());
  return {static_cast<std::int32_t>(random() % count), (1.0 / (n[0] + n[1] + n[2])) * n};
}

void expect_natural(const Vec3& natural) {
  EXPECT_NEAR(natural[0] + natural[1] + natural[2], 1, 1e-14);
  for (const double n : natural) EXPECT_GE(n, 0);
}

TEST(Walk, IsAStraightLineOnAPlate) {
  const Surface surface(plate(10, 0.1, uniform));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int trial = 0; trial < 5000; ++trial) {
    const SurfacePoint from = random_point(surface, random);
    const Vec3 start = surface.position(from);
    Vec3 direction{any(random), any(random), 0};
    direction = (1.0 / norm(direction)) * direction;
    const double distance = 0.04 * std::abs(any(random));
    const Vec3 end = start + distance * direction;
    if (std::min(end[0], end[1]) < 0 || std::max(end[0], end[1]) > 0.1) continue;
    // A part of the direction along the normal changes nothing: its projection counts.
    const Walk w = walk(surface, from, direction + Vec3{0, 0, 0.3}, distance);
    EXPECT_NEAR(norm(surface.position(w.point) - end), 0, 1e-13);
    EXPECT_FALSE(w.at_border);
    expect_natural(w.point.natural);
  }
}

TEST(Walk, GoesThroughVerticesAndAlongEdges) {
  const Surface surface(plate(10, 0.1, uniform));
  // From vertex to vertex: along the edges in x, along the diagonals, and through opposite corners.
  for (const Vec3& direction :
       {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{1, 1, 0}, Vec3{-1, 1, 0}, Vec3{2, 1, 0}}) {
    for (std::int32_t m = 0; m < surface.element_count(); ++m) {
      const Vec3 start = surface.position({m, {1, 0, 0}});
      if (start[0] < 0.039 || start[0] > 0.061 || start[1] < 0.039 || start[1] > 0.061) continue;
      const Vec3 unit = (1.0 / norm(direction)) * direction;
      const Walk w = walk(surface, {m, {1, 0, 0}}, unit, 0.035);
      EXPECT_NEAR(norm(surface.position(w.point) - (start + 0.035 * unit)), 0, 1e-13)
          << m << " " << unit[0] << " " << unit[1];
    }
  }
}

TEST(Walk, DoesNotDependOnTheLengthOfTheDirection) {
  for (const Surface& surface :
       {Surface(bumpy_sphere(2, 0.03, 0.2, uniform)), Surface(cube(3, 0.03, uniform)),
        Surface(plate(4, 0.03, uniform))}) {
    std::mt19937 random(6);
    std::normal_distribution<double> any;
    for (int trial = 0; trial < 2000; ++trial) {
      const SurfacePoint from = random_point(surface, random);
      Vec3 direction{any(random), any(random), any(random)};
      direction = (1.0 / norm(direction)) * direction;
      const double distance = 0.01 * std::abs(any(random));
      const Walk unit = walk(surface, from, direction, distance);
      for (const double length : {1e-6, 1e-3, 1e3}) {
        const Walk w = walk(surface, from, length * direction, distance);
        EXPECT_NEAR(norm(surface.position(w.point) - surface.position(unit.point)), 0, 1e-13);
        EXPECT_EQ(w.at_border, unit.at_border);
        EXPECT_EQ(w.hindered, unit.hindered);
      }
    }
  }
}

TEST(Walk, KeepsItsLengthOnACurvedSurface) {
  const double radius = 0.03;
  const Surface surface(sphere(4, radius, uniform));
  std::mt19937 random(2);
  std::normal_distribution<double> any;
  for (int trial = 0; trial < 500; ++trial) {
    const SurfacePoint from = random_point(surface, random);
    const Vec3 start = surface.position(from);
    Vec3 t{any(random), any(random), any(random)};
    t = t - (dot(t, start) / dot(start, start)) * start;
    t = (1.0 / norm(t)) * t;
    const Walk w = walk(surface, from, t, 0.01);
    const Vec3 end = surface.position(w.point);
    const double angle = std::acos(dot(start, end) / (norm(start) * norm(end)));
    EXPECT_NEAR(angle * radius, 0.01, 1e-4);
    // It stays in the plane through the centre, the start and the direction.
    EXPECT_NEAR(dot(end, cross(start, t)) / norm(start), 0, 1.5e-4);
  }
}

TEST(Walk, FollowsABorderAndStopsInItsCorner) {
  const Surface surface(plate(10, 0.1, uniform));
  std::mt19937 random(3);
  for (int trial = 0; trial < 500; ++trial) {
    const SurfacePoint from = random_point(surface, random);
    const Vec3 start = surface.position(from);
    // Outwards over x = 0.1 and slowly up in y: reach the rim, then keep only the motion in y.
    const Vec3 direction{0.8, 0.6, 0};
    const double to_rim = (0.1 - start[0]) / 0.8;
    const double distance = to_rim + 0.02;
    const Walk w = walk(surface, from, direction, distance);
    const Vec3 end = surface.position(w.point);
    if (start[1] + 0.6 * distance < 0.1) {
      EXPECT_NEAR(end[0], 0.1, 1e-13);
      EXPECT_NEAR(end[1], start[1] + 0.6 * distance, 1e-12);
    }
    EXPECT_TRUE(w.at_border);
    expect_natural(w.point.natural);
  }
  const Walk corner = walk(surface, {0, {0.3, 0.3, 0.4}}, {0.7, 0.714, 0}, 5.0);
  EXPECT_NEAR(norm(surface.position(corner.point) - Vec3{0.1, 0.1, 0}), 0, 1e-12);
}

TEST(Walk, AHoleIsABorder) {
  Library library = plate(10, 0.1, uniform);
  library.responses[5 * 11 + 5] = {};  // vertex (0.05, 0.05)
  const Surface surface(library);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int trial = 0; trial < 5000; ++trial) {
    const SurfacePoint from = random_point(surface, random);
    if (!surface.element(from.element).active) continue;
    const Walk w = walk(surface, from, {any(random), any(random), any(random)}, 0.05);
    EXPECT_TRUE(surface.element(w.point.element).active);
    expect_natural(w.point.natural);
  }
}

TEST(Walk, AlongTheNormalStays) {
  const Surface surface(plate(4, 0.04, uniform));
  const SurfacePoint from{7, {0.2, 0.5, 0.3}};
  const Walk w = walk(surface, from, {0, 0, 1}, 0.01);
  EXPECT_EQ(w.point.element, 7);
  EXPECT_NEAR(norm(surface.position(w.point) - surface.position(from)), 0, 1e-16);
}

}  // namespace
}  // namespace palpate::test
