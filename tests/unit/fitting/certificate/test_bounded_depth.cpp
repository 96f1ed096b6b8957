// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/bounded_depth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/unit/fitting/certificate/plain_model.hpp"

namespace palpate::fitting {
namespace {

constexpr double kDepth = 0.02;  // m

double largest_slip(const Library& library, double depth, double friction) {
  double largest = 0;
  for (const TriangleBounds& b : triangle_bounds(library, depth, friction))
    largest = std::max(largest, b.certificate.slip);
  return largest;
}

// Without friction the denominator of (10) is cos theta - D kappa.
TEST(BoundedDepth, IsTheRadiusOfCurvatureWithoutFriction) {
  std::mt19937 engine(5);
  int limited = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const Library library = random_triangle(engine, 0.4, 0.3);
    const TriangleFrame frame = triangle_frame(library, 0);
    const double exact = std::min(kDepth, frame.cos_theta / frame.kappa);
    const double found = bounded_depth(library, triangle_bounds(library, kDepth, 0), kDepth, 0);
    EXPECT_LE(found, exact);
    EXPECT_NEAR(found, exact, kDepth / 64);
    limited += exact < kDepth ? 1 : 0;
  }
  EXPECT_GT(limited, 10);
}

// Equal responses on a sphere of 5 mm: |w| of (10) is finite up to less than the radius.
TEST(BoundedDepth, OfASphereHasFiniteBoundsAndNoneMuchDeeper) {
  Library library = sphere(0.005, 1);
  set_equal_responses(library, node_response(linear_curve(100), linear_curve(80)));
  const double found = bounded_depth(library, triangle_bounds(library, kDepth, 0.3), kDepth, 0.3);
  EXPECT_GT(found, 0.002);
  EXPECT_LT(found, 0.005);
  EXPECT_TRUE(std::isfinite(largest_slip(library, found, 0.3)));
  EXPECT_TRUE(std::isinf(largest_slip(library, found + kDepth / 16, 0.3)));
}

}  // namespace
}  // namespace palpate::fitting
