// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
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

/// Rosenbrock's valley, with fewer iterations than it takes: no constants, but where they are.
TEST(LeastSquares, RefusesWhatDoesNotConverge) {
  LeastSquares problem;
  problem.constants = {{"x", "1", -1.2, -10, 10}, {"y", "1", 1, -10, 10}};
  problem.residuals = 2;
  problem.max_iterations = 3;
  problem.model = [](const double* c, double* r, double* J) {
    r[0] = 10 * (c[1] - c[0] * c[0]);
    r[1] = 1 - c[0];
    if (J == nullptr) return true;
    J[0] = -20 * c[0], J[1] = 10, J[2] = -1, J[3] = 0;
    return true;
  };
  EXPECT_THAT(refusal(problem), HasSubstr("the iteration does not converge; after 3 iterations"));
  EXPECT_FALSE(converged_minimum(problem, {{-1.2, 1}, {-5, 2}}, "valley"));
  try {
    minimise(problem, {{-1.2, 1}, {-5, 2}}, "valley");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("valley: none of 2 starts converges"));
    EXPECT_THAT(error.remedy(), HasSubstr("fewer constants"));
  }
  problem.max_iterations = 200;
  const auto found = converged_minimum(problem, {{-1.2, 1}}, "valley");
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->estimates[0].value, 1, 1e-6);
}

/// Constants that are the same model in another order come out in one.
TEST(LeastSquares, GivesTheCanonicalOneOfEqualSets) {
  LeastSquares problem;
  problem.constants = {{"a", "1", 1, -10, 10}, {"b", "1", 2, -10, 10}};
  problem.residuals = 2;
  problem.model = [](const double* c, double* r, double* J) {  // a + b = 3, a b = 2
    r[0] = c[0] + c[1] - 3;
    r[1] = c[0] * c[1] - 2;
    if (J != nullptr) J[0] = J[1] = 1, J[2] = c[1], J[3] = c[0];
    return true;
  };
  problem.canonical = [](std::vector<double>& c) { std::sort(c.begin(), c.end()); };
  for (const std::vector<double>& start : {std::vector<double>{0.5, 5}, {5, 0.5}}) {
    const Calibration fit = minimise(problem, {start}, "roots");
    EXPECT_NEAR(fit.estimates[0].value, 1, 1e-6);
    EXPECT_NEAR(fit.estimates[1].value, 2, 1e-6);
    EXPECT_TRUE(minimise(problem, {{0.5, 5}, {5, 0.5}}, "roots").warnings == fit.warnings);
  }
}

}  // namespace
}  // namespace palpate::calibrate
