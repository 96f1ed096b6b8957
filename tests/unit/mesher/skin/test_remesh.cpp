// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesher/geometry/queries.hpp"
#include "mesher/skin/remesh.hpp"
#include "tests/unit/mesher/refusals.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refused;
using test::off_text;
using test::settings_for;
using test::TemporaryFile;

constexpr double kFeatureAngle = std::numbers::pi / 4;

TEST(Remesh, BoxKeepsItsEdgesAndCornersExactly) {
  const Surface box = test::box({0, 0, 0}, {0.05, 0.04, 0.03});
  const NestedSurface nested = remesh(box, {0.008, 3, kFeatureAngle}, "box", {});
  EXPECT_NEAR(signed_volume(nested.boundary), 0.05 * 0.04 * 0.03, 1e-15);
  EXPECT_NEAR(area(nested.boundary), 2 * (0.05 * 0.04 + 0.05 * 0.03 + 0.04 * 0.03), 1e-12);
  for (const Vec3& corner : box.points) {
    const auto& points = nested.response.points;
    EXPECT_TRUE(std::any_of(points.begin(), points.end(),
                            [&](const Vec3& x) { return norm(x - corner) < 1e-12; }));
  }
}

TEST(Remesh, EdgesOfTheResponseSurfaceAreNearTheSpacing) {
  const NestedSurface nested =
      remesh(test::sphere({0, 0, 0}, 0.05, 120), {0.010, 1, kFeatureAngle}, "s", {});
  double sum = 0;
  for (const Triangle& t : nested.response.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = norm(nested.response.points[static_cast<std::size_t>(t[k])] -
                                 nested.response.points[static_cast<std::size_t>(t[(k + 1) % 3])]);
      EXPECT_GT(length, 0.005);
      EXPECT_LT(length, 0.015);
      sum += length;
    }
  }
  EXPECT_NEAR(sum / static_cast<double>(3 * nested.response.triangles.size()), 0.010, 0.001);
}

TEST(Remesh, AllPointsLieOnTheInputSurface) {
  const Surface input = test::cylinder(0.04, 0.08, 200);
  const NestedSurface nested = remesh(input, {0.012, 4, kFeatureAngle}, "c", {});
  const SurfaceQuery query(input);
  for (const Vec3& x : nested.boundary.points) EXPECT_LT(norm(query.closest(x).point - x), 1e-9);
}

// The middles lie on the surface of the file, its rims included; a box has none.
TEST(Remesh, MiddlesOfCurvedEdgesLieOnTheInputSurface) {
  constexpr double kRadius = 0.04, kLength = 0.08;
  const Surface input = test::cylinder(kRadius, kLength, 400);
  const double chord = kRadius * (1 - std::cos(M_PI / 400));  // of the file
  const NestedSurface nested = remesh(input, {0.012, 2, kFeatureAngle, true}, "c", {});
  EXPECT_GT(nested.curved.size(), nested.boundary.triangles.size() / 2);
  const SurfaceQuery query(input);
  std::size_t on_rims = 0;
  for (const CurvedEdge& edge : nested.curved) {
    EXPECT_LT(norm(query.closest(edge.middle).point - edge.middle), 1e-9);
    const auto end = [&](std::size_t i) {
      return nested.boundary.points[static_cast<std::size_t>(edge.ends[i])];
    };
    EXPECT_NEAR(std::hypot(edge.middle[0], edge.middle[1]), kRadius, 1.1 * chord);
    const double straight = std::hypot(0.5 * (end(0) + end(1))[0], 0.5 * (end(0) + end(1))[1]);
    EXPECT_GT(std::hypot(edge.middle[0], edge.middle[1]), straight);
    const bool rim = end(0)[2] == end(1)[2] && (end(0)[2] == 0 || end(0)[2] == kLength);
    on_rims += rim && std::abs(edge.middle[2] - end(0)[2]) < 1e-12;
  }
  EXPECT_GT(on_rims, 2 * 2 * M_PI * kRadius / 0.0075);  // facets of 6 mm around both
  EXPECT_TRUE(
      remesh(test::box({0, 0, 0}, {0.05, 0.04, 0.03}), {0.008, 3, kFeatureAngle, true}, "b", {})
          .curved.empty());
}

TEST(Remesh, RefusesPatchesCoarserThanTheDetail) {
  // A thin shell: patches of 30 mm do not resolve two walls that are 2 mm apart.
  const TemporaryFile file("shell.off", off_text([] {
                             Surface bowl = test::sphere({0, 0, 0}, 0.05, 64);
                             for (Vec3& x : bowl.points) {
                               if (x[2] > 0)
                                 x = Vec3{0.96 * x[0], 0.96 * x[1], 0.002 - 0.96 * x[2]};
                             }
                             return bowl;
                           }()));
  Settings s = settings_for(file.path());
  s.patch_spacing = s.element_size = 0.03;
  s.method = MeshMethod::Isotropic;
  expect_refused(s, "shell.off", "remesh", "reduce the spacing");
}

}  // namespace
}  // namespace palpate::mesher
