// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "fem/campaign/path_work.hpp"

namespace palpate::fem {
namespace {

TEST(RunningIntegral, IsExactForParabolasOnUnevenSteps) {
  const std::vector<double> x{0, 0.1, 0.15, 0.4, 0.7, 1.0};
  std::vector<double> y;
  for (const double v : x) y.push_back(2 - v + 3 * v * v);
  const auto sum = running_integral(x, y);
  for (std::size_t i = 0; i < x.size(); ++i)
    EXPECT_NEAR(sum[i], 2 * x[i] - x[i] * x[i] / 2 + x[i] * x[i] * x[i], 1e-14);
}

TEST(RunningIntegral, OfAHertzCurveConverges) {
  const auto error = [](int n) {
    std::vector<double> x, y;
    for (int i = 0; i <= n; ++i) {
      x.push_back(static_cast<double>(i) / n);
      y.push_back(std::pow(x.back(), 1.5));
    }
    return std::abs(running_integral(x, y).back() - 0.4);
  };
  EXPECT_LT(error(12), 3e-4);
  EXPECT_LT(error(24), 0.25 * error(12));
}

}  // namespace
}  // namespace palpate::fem
