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
  EXPECT_NEAR(Skin(body).distance({0.1, 0.2, 0}, {0, 0, -1}), -0.002, 1e-15);     // bulges out
  EXPECT_NEAR(Skin(body).distance({0.1, 0.2, 0.005}, {0, 0, -1}), 0.003, 1e-15);  // lies below
}

TEST(Skin, IsFoundAlongALeaningDirection) {
  const Body body = slab(0.002, -1, 0);
  const Vec3 inward{0.6, 0, -0.8};
  EXPECT_NEAR(Skin(body).distance({0, 0, 0.004}, inward), 0.002 / 0.8, 1e-15);
}

TEST(Skin, IsFoundOnTheEdgeBetweenTwoFacets) {
  const Body body = slab(0.002, -1, 0);
  for (const double x : {-0.9, -0.3, 0.0, 0.25, 0.7})
    EXPECT_NEAR(Skin(body).distance({x, x, 0}, {0, 0, -1}), -0.002, 1e-15);
}

TEST(Skin, IsNotWhereTheLineLeavesTheBody) {
  // The lower side is nearer to the point, but the line leaves the body there.
  const Body body = slab(0.002, -0.001, 0.0005);
  EXPECT_NEAR(Skin(body).distance({0.5, 0.1, -0.0008}, {0, 0, -1}), -0.0028, 1e-15);
  // From below it enters there: z = -0.001 + 0.0005 * 0.5.
  EXPECT_NEAR(Skin(body).distance({0.5, 0.1, -0.0008}, {0, 0, 1}), 0.00005, 1e-15);
}

// A paraboloid is quadratic over every facet, so curved edges make it whole.
TEST(Skin, IsTheCurvedOneWhereEdgesAreCurved) {
  constexpr double kBend = 3;  // 1/m
  const auto on_paraboloid = [](double x, double y) {
    return Vec3{x, y, -kBend * (x * x + 2 * y * y)};
  };
  Body body;
  body.nodes = {on_paraboloid(-0.01, -0.01), on_paraboloid(0.01, -0.008),
                on_paraboloid(-0.012, 0.01), on_paraboloid(0.01, 0.011)};
  body.boundary = {{0, 1, 3}, {0, 3, 2}};
  for (const Edge& e : {Edge{0, 1}, Edge{0, 2}, Edge{0, 3}, Edge{1, 3}, Edge{2, 3}}) {
    const Vec3 middle = 0.5 * (body.nodes[static_cast<std::size_t>(e[0])] +
                               body.nodes[static_cast<std::size_t>(e[1])]);
    body.curved_edges.push_back({e, on_paraboloid(middle[0], middle[1])});
  }
  const Skin skin(body);
  for (const double lean : {-0.3, 0.0, 0.2})
    for (const double x : {-0.005, 0.0, 0.003})
      for (const double y : {-0.004, 0.001, 0.006}) {
        const Vec3 inward{lean, 0.5 * lean, -std::sqrt(1 - 1.25 * lean * lean)};
        const Vec3 position{x, y, -0.0002};
        const Vec3 at = position + skin.distance(position, inward) * inward;
        EXPECT_NEAR(at[2], on_paraboloid(at[0], at[1])[2], 1e-13);
      }
  body.curved_edges.clear();
  EXPECT_GT(std::abs(Skin(body).distance({0, 0.004, 0}, {0, 0, -1}) -
                     skin.distance({0, 0.004, 0}, {0, 0, -1})),
            1e-4);
}

TEST(Skin, MustBeSomewhere) {
  EXPECT_THROW(Skin(slab(0.002, -1, 0)).distance({3, 0, 0}, {0, 0, -1}), Error);
}

}  // namespace
}  // namespace palpate::fidelity
