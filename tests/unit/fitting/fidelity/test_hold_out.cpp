// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/fidelity/hold_out.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/support/surfaces.hpp"

namespace palpate::fidelity {
namespace {

/// Two triangles in the plane z = 0, the second with twice the area of the first.
Library even_plate() {
  Library library;
  library.name = "plate";
  library.positions = {{0, 0, 0}, {0.02, 0, 0}, {0, 0.02, 0}, {-0.04, 0, 0}};
  library.inward.assign(4, Vec3{0, 0, -1});
  library.triangles = {{0, 1, 2}, {0, 2, 3}};
  fitting::set_equal_responses(
      library, fitting::node_response(fitting::linear_curve(120), fitting::linear_curve(80)));
  return library;
}

TEST(HoldOut, PointsAreUniformOverTheSurfaceAndNotAtHoles) {
  Library library = even_plate();
  const auto points = draw_points(library, 6000, 4, 1);
  ASSERT_EQ(points.size(), 6004u);
  const auto in_large = std::count_if(points.begin(), points.begin() + 6000,
                                      [](const HoldOutPoint& p) { return p.triangle == 1; });
  EXPECT_NEAR(static_cast<double>(in_large) / 6000, 2.0 / 3, 4 * std::sqrt(2.0 / 9 / 6000));
  // The mean of uniform points is the centroid of the two triangles.
  Vec3 mean{};
  for (int i = 0; i < 6000; ++i)
    mean = mean + (1.0 / 6000) * points[static_cast<std::size_t>(i)].position;
  const Vec3 centroid = (1.0 / 3) * ((1.0 / 3) * Vec3{0.02, 0.02, 0}) +
                        (2.0 / 3) * ((1.0 / 3) * Vec3{-0.04, 0.02, 0});
  EXPECT_LT(norm(mean - centroid), 6e-4);
  std::set<Vec3> nodes;
  for (std::size_t i = 6000; i < points.size(); ++i) {
    EXPECT_TRUE(points[i].node);
    nodes.insert(points[i].position);
  }
  EXPECT_EQ(nodes.size(), 4u);
  library.responses[1] = {};
  for (const HoldOutPoint& p : draw_points(library, 50, 0, 1)) EXPECT_EQ(p.triangle, 1);
  library.responses[0] = {};
  EXPECT_ANY_THROW(draw_points(library, 1, 0, 1));
}

TEST(HoldOut, TheSameSeedGivesTheSamePoints) {
  const Library library = even_plate();
  const auto first = draw_points(library, 20, 2, 9), again = draw_points(library, 20, 2, 9);
  const auto other = draw_points(library, 20, 2, 10);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].position, again[i].position);
  EXPECT_NE(first[0].position, other[0].position);
}

}  // namespace
}  // namespace palpate::fidelity
