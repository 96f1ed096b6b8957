// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fitting/measurement/relaxation/information.hpp"

namespace palpate::calibrate {
namespace {

TEST(Information, FindsTheCorrelationOfTheNoise) {
  for (const double r : {0.0, 0.6, 0.9}) {
    std::mt19937 engine(2);
    std::normal_distribution<double> normal;
    std::vector<double> e{normal(engine)};
    while (e.size() < 4000) e.push_back(r * e.back() + std::sqrt(1 - r * r) * normal(engine));
    EXPECT_NEAR(information_of(e, {1500, 2500}, 3).autocorrelation, r, 0.03);
  }
}

/// Independent residuals: n ln(s^2) + k ln n, k with the variance and the correlation.
TEST(Information, OfIndependentNoiseIsTheTextbookFormula) {
  std::vector<double> e;
  for (int i = 0; i < 200; ++i) e.push_back(i % 4 < 2 ? 0.1 : -0.1);  // no pairs in the sum
  const Information found = information_of(e, {200}, 4);
  EXPECT_NEAR(found.bic, 200 * std::log(0.01) + 6 * std::log(200.0), 0.1);
  EXPECT_NEAR(found.aicc - information_of(e, {200}, 3).aicc,
              2 + 2.0 * 6 * 7 / 193 - 2.0 * 5 * 6 / 194, 1e-9);
}

}  // namespace
}  // namespace palpate::calibrate
