// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/init/facet_width.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace palpate::app {
namespace {

/// A prism of `sides` rectangles, `height` high, with fans of triangles at both ends.
mesher::Surface prism(int sides, double radius, double height) {
  mesher::Surface s;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    for (const double z : {0.0, height})
      s.points.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
  }
  const auto low = static_cast<std::int32_t>(s.points.size()), high = low + 1;
  s.points.push_back({0, 0, 0});
  s.points.push_back({0, 0, height});
  for (std::int32_t i = 0; i < sides; ++i) {
    const std::int32_t a = 2 * i, b = 2 * ((i + 1) % sides);
    s.triangles.push_back({a, b, b + 1});
    s.triangles.push_back({a, b + 1, a + 1});
    s.triangles.push_back({low, b, a});
    s.triangles.push_back({high, a + 1, b + 1});
  }
  return s;
}

TEST(FacetWidth, IsTheLengthOfTheEdgesAtWhichASurfaceBends) {
  // Its sides bend by 15 degrees at edges as long as the prism is high; rims are sharp, and the
  // diagonals of its sides and caps are flat.
  EXPECT_NEAR(facet_width(prism(24, 0.02, 0.03)), 0.03, 1e-12);
}

TEST(FacetWidth, OfABodyOfFlatFacesIsNone) {
  EXPECT_EQ(facet_width(prism(4, 0.02, 0.03)), 0);
}

}  // namespace
}  // namespace palpate::app
