// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/extrapolation.hpp"

#include <gtest/gtest.h>

#include <array>

namespace palpate::fem {
namespace {

TEST(ExtrapolationWeights, EvaluateThePolynomialThroughTheValues) {
  const std::array<double, 4> s{0, 0.4, 1, 1.1};
  const auto cubic = [](double x) { return 2 - x + 3 * x * x - 0.7 * x * x * x; };
  for (const double at : {0.4, 1.3, 2.0}) {
    const std::vector<double> w = extrapolation_weights(s, at);
    double sum = 0, one = 0;
    for (std::size_t i = 0; i < s.size(); ++i) {
      sum += w[i] * cubic(s[i]);
      one += w[i];
    }
    EXPECT_NEAR(sum, cubic(at), 1e-11);
    EXPECT_NEAR(one, 1, 1e-11);
  }
}

TEST(ExtrapolationWeights, OfOneValueAreOne) {
  const std::array<double, 1> s{0.3};
  EXPECT_EQ(extrapolation_weights(s, 5.0), std::vector<double>{1.0});
}

}  // namespace
}  // namespace palpate::fem
