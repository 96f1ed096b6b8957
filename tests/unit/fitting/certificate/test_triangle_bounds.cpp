// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/certificate/triangle_bounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "fitting/certificate/slide_bound.hpp"
#include "tests/support/surfaces.hpp"

namespace palpate::fitting {
namespace {

TEST(TriangleBounds, OfEqualSpringsAreTheClosedForm) {
  constexpr double k = 200, mu = 0.3;
  Library library = flat_triangle();
  set_equal_responses(library, node_response(linear_curve(k), linear_curve(k)));
  const auto bounds = triangle_bounds(library, 0.008, mu);
  ASSERT_EQ(bounds.size(), 1u);
  EXPECT_DOUBLE_EQ(bounds[0].certificate.stick, k);
  EXPECT_NEAR(bounds[0].certificate.slip, k * std::hypot(1.0, mu), 1e-9);
  EXPECT_NEAR(bounds[0].min_lipschitz_bound, k * std::hypot(1.0, mu), 1e-9);
}

TEST(TriangleBounds, TheSearchLowersBoundsOfTheClosedFormAndNeverRaisesThem) {
  std::mt19937 engine(91);
  Library library = sphere(0.04, 1);
  for (std::size_t v = 0; v < library.positions.size(); ++v)
    library.responses.push_back(random_response(engine, 0.2));
  const auto bounds = triangle_bounds(library, 0.008, 0.3);
  double closed = 0, searched = 0;
  for (std::size_t m = 0; m < bounds.size(); ++m) {
    const double total = slide_bound(contact_element(library, m, 0.008, 0.3)).total;
    EXPECT_LE(bounds[m].certificate.slip, total);
    closed = std::max(closed, total);
    searched = std::max(searched, bounds[m].certificate.slip);
  }
  EXPECT_LT(searched, closed);
}

TEST(TriangleBounds, ATriangleAtAHoleHasBoundsOfZero) {
  Library library = sphere(0.04, 0);
  set_equal_responses(library, node_response(linear_curve(100, 0.001), linear_curve(80)));
  library.responses[7] = NodeResponse{};
  const auto bounds = triangle_bounds(library, 0.001, 0.3);
  for (std::size_t m = 0; m < bounds.size(); ++m) {
    const Triangle& t = library.triangles[m];
    EXPECT_EQ(bounds[m].certificate.stick == 0, std::count(t.begin(), t.end(), 7) == 1);
  }
}

}  // namespace
}  // namespace palpate::fitting
