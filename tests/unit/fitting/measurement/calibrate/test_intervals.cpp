// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fitting/measurement/calibrate/intervals.hpp"
#include "tests/unit/fitting/measurement/calibrate/line.hpp"

namespace palpate::calibrate {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// t s/sqrt(sum x^2), with t of four degrees of freedom [Abramowitz & Stegun 1964, table 26.10].
TEST(Intervals, AreThoseOfALine) {
  const Line line;
  const Calibration fit = minimise(line.problem(), "line");
  const double s = std::sqrt(line.squares(line.best()) / 4);
  EXPECT_EQ(fit.freedom, 4);
  EXPECT_NEAR(fit.scatter, s, 1e-9);
  EXPECT_NEAR(fit.estimates[0].unit_error, 1 / std::sqrt(line.xx()), 1e-12);
  EXPECT_NEAR(fit.estimates[0].standard_error, s / std::sqrt(line.xx()), 1e-9);
  EXPECT_NEAR(fit.estimates[0].high - fit.estimates[0].value, 2.776445 * s / std::sqrt(line.xx()),
              1e-6);
}

/// Residuals over a stated uncertainty have a scatter of one; beyond chance the intervals widen.
TEST(Intervals, UseAStatedUncertaintyUnlessTheResidualsExceedIt) {
  const Line line;
  LeastSquares problem = line.problem();
  problem.known_scatter = true;
  const Calibration fit = minimise(problem, "line");
  EXPECT_FALSE(fit.widened);
  EXPECT_NEAR(fit.estimates[0].high - fit.estimates[0].value, 1.959964 / std::sqrt(line.xx()),
              1e-6);
  problem.model = [&](const double* c, double* r, double* J) {  // a hundredth of the uncertainty
    for (std::size_t i = 0; i < line.x.size(); ++i) {
      r[i] = 100 * (c[0] * line.x[i] - line.y[i]);
      if (J != nullptr) J[i] = 100 * line.x[i];
    }
    return true;
  };
  const Calibration widened = minimise(problem, "line");
  EXPECT_TRUE(widened.widened);
  EXPECT_THAT(widened.warnings, Contains(HasSubstr("times the stated uncertainty")));
}

/// y = a x + b x with nothing to tell a from b, a constant that acts on nothing, and as many
/// constants as values: intervals without end, but none that is no number, and no correlation
/// beyond one.
TEST(Intervals, AreNumbersWhereTheDataDetermineNothing) {
  LeastSquares problem;
  problem.constants = {{"a", "1", 1, -10, 10}, {"b", "1", 1, -10, 10}, {"c", "1", 1, -10, 10}};
  problem.residuals = 5;
  problem.series = {5};
  problem.model = [](const double* c, double* r, double* J) {
    for (int i = 0; i < 5; ++i) {
      const double x = 0.1 * (1 + i);
      r[i] = (c[0] + c[1]) * x - 2 * x - (i % 2 == 0 ? 0.01 : -0.01);
      if (J == nullptr) continue;
      J[3 * i] = J[3 * i + 1] = x;
      J[3 * i + 2] = 0;
    }
    return true;
  };
  const Calibration fit = minimise(problem, "sum");
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_FALSE(std::isnan(fit.estimates[i].low)) << i;
    EXPECT_FALSE(std::isnan(fit.estimates[i].high)) << i;
    EXPECT_GT(fit.estimates[i].high - fit.estimates[i].low, 1e3) << i;
    for (std::size_t j = 0; j < 3; ++j) EXPECT_LE(std::abs(fit.correlation[i][j]), 1) << i << j;
    EXPECT_THAT(fit.warnings, Contains(HasSubstr(fit.estimates[i].name + " is not determined")));
  }
  EXPECT_NEAR(fit.correlation[0][1], -1, 1e-9);
  problem.constants.resize(1);
  problem.residuals = 1;
  problem.series = {1};
  problem.model = [](const double* c, double* r, double* J) {
    r[0] = c[0] - 2;
    if (J != nullptr) J[0] = 1;
    return true;
  };
  const Estimate one = minimise(problem, "value").estimates[0];
  EXPECT_EQ(one.low, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(one.high, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace palpate::calibrate
