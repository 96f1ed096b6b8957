// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/fidelity/skin.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "format/error.hpp"

namespace palpate::fidelity {
namespace {

/// A slab between two planes, each of two triangles, outward: the lower leans by a slope.
Body slab(double top, double bottom, double slope) {
  Body body;
  body.name = "slab";
  for (const double z : {top, bottom})
    for (const double y : {-1.0, 1.0})
      for (const double x : {-1.0, 1.0}) body.nodes.push_back({x, y, z == top ? z : z + slope * x});
  body.boundary = {{0, 1, 3}, {0, 3, 2}, {4, 7, 5}, {4, 6, 7}};
  return body;
}

TEST(Skin, IsWhereTheLineEntersTheBody) {
  const Body body = slab(0.002, -1, 0);
  EXPECT_NEAR(skin_beside(body, {0.1, 0.2, 0}, {0, 0, -1}), -0.002, 1e-15);     // bulges out
  EXPECT_NEAR(skin_beside(body, {0.1, 0.2, 0.005}, {0, 0, -1}), 0.003, 1e-15);  // lies below
}

TEST(Skin, IsFoundAlongALeaningDirection) {
  const Body body = slab(0.002, -1, 0);
  const Vec3 inward{0.6, 0, -0.8};
  EXPECT_NEAR(skin_beside(body, {0, 0, 0.004}, inward), 0.002 / 0.8, 1e-15);
}

TEST(Skin, IsFoundOnTheEdgeBetweenTwoFacets) {
  const Body body = slab(0.002, -1, 0);
  for (const double x : {-0.9, -0.3, 0.0, 0.25, 0.7})
    EXPECT_NEAR(skin_beside(body, {x, x, 0}, {0, 0, -1}), -0.002, 1e-15);
}

TEST(Skin, IsNotWhereTheLineLeavesTheBody) {
  // The lower side is nearer to the point, but the line leaves the body there.
  const Body body = slab(0.002, -0.001, 0.0005);
  EXPECT_NEAR(skin_beside(body, {0.5, 0.1, -0.0008}, {0, 0, -1}), -0.0028, 1e-15);
  // From below it enters there: z = -0.001 + 0.0005 * 0.5.
  EXPECT_NEAR(skin_beside(body, {0.5, 0.1, -0.0008}, {0, 0, 1}), 0.00005, 1e-15);
}

TEST(Skin, MustBeSomewhere) {
  EXPECT_THROW(skin_beside(slab(0.002, -1, 0), {3, 0, 0}, {0, 0, -1}), Error);
}

}  // namespace
}  // namespace palpate::fidelity
