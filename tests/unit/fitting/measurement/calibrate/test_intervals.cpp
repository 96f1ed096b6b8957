// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace palpate::calibrate
