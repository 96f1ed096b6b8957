// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "fitting/measurement/calibrate/least_squares.hpp"
#include "format/error.hpp"
#include "tests/unit/fitting/measurement/calibrate/line.hpp"

namespace palpate::calibrate {
namespace {

using testing::Contains;
using testing::HasSubstr;

std::string refusal(const LeastSquares& problem) {
  try {
    minimise(problem, "line");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    return error.what();
  }
  return "accepted";
}

TEST(LeastSquares, FindsTheClosedFormOfALine) {
  const Line line;
  const Calibration fit = minimise(line.problem(), "line");
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.estimates[0].value, line.best(), 1e-7);
  EXPECT_NEAR(fit.cost, 0.5 * line.squares(line.best()), 1e-12);
  EXPECT_TRUE(fit.warnings.empty());
}

TEST(LeastSquares, WarnsOfAConstantAtItsBound) {
  const Line line;
  const Calibration fit = minimise(line.problem(0, 0.5), "line");
  EXPECT_TRUE(fit.estimates[0].at_bound);
  EXPECT_THAT(fit.warnings, Contains(HasSubstr("k is at its bound 0.5")));
}

TEST(LeastSquares, TakesTheBestOfSeveralStartsAndNamesAnEqualOne) {
  const Line line;
  LeastSquares problem = line.problem();
  problem.constants = {{"k", "1", 1, -10, 10}};
  problem.model = [&](const double* c, double* r, double* J) {  // k and -k fit alike
    for (std::size_t i = 0; i < line.x.size(); ++i) {
      r[i] = c[0] * c[0] * line.x[i] - line.y[i];
      if (J != nullptr) J[i] = 2 * c[0] * line.x[i];
    }
    return true;
  };
  const Calibration fit = minimise(problem, {{2}, {-2}}, "line");
  EXPECT_NEAR(fit.estimates[0].value, std::sqrt(line.best()), 1e-6);
  EXPECT_THAT(fit.warnings, Contains(HasSubstr("another set of constants fits as well: k = -")));
}

TEST(LeastSquares, RefusesProblemsThatHaveNoSolution) {
  const Line line;
  LeastSquares problem = line.problem();
  problem.residuals = 0;
  EXPECT_THAT(refusal(problem), HasSubstr("0 values cannot determine 1 constants"));
  problem = line.problem();
  problem.constants[0].start = 11;
  EXPECT_THAT(refusal(problem), HasSubstr("the start 11.0 of k is not within -10.0 .. 10.0"));
  problem = line.problem();
  problem.model = [](const double*, double*, double*) { return false; };
  EXPECT_THAT(refusal(problem), HasSubstr("the model has no value near the start"));
}

}  // namespace
}  // namespace palpate::calibrate
