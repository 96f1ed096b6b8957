// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/inside_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

TEST(InsideGrid, AgreesWithExactPredicatesAndBoundsTheDistance) {
  const Surface ball = test::sphere({0.1, 0.2, 0.3}, 0.4, 24);
  const InsideGrid grid(ball);
  const SurfaceQuery query(ball);
  for (int n = 0; n < 3000; ++n) {
    const Vec3 x{std::sin(1.1 * n), std::sin(1.7 * n + 1), std::sin(2.3 * n + 2)};
    EXPECT_EQ(grid.contains(x), query.contains(x));
    const double distance = norm(query.closest(x).point - x);
    const auto range = grid.distance_range(x);
    EXPECT_LE(range.low, distance + 1e-12);
    EXPECT_GE(range.high, distance - 1e-12);
  }
}

}  // namespace
}  // namespace palpate::mesher
