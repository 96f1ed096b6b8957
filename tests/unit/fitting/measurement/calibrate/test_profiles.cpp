// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include <cmath>
#include <limits>
#include <vector>

#include "fitting/measurement/calibrate/least_squares.hpp"

namespace palpate::calibrate {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// y = exp(c) x.
LeastSquares exponential_line(const std::vector<double>& x, const std::vector<double>& y,
                              const Constant& c) {
  LeastSquares problem;
  problem.constants = {c};
  problem.residuals = x.size();
  problem.model = [x, y](const double* constants, double* r, double* J) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      r[i] = std::exp(constants[0]) * x[i] - y[i];
      if (J != nullptr) J[i] = std::exp(constants[0]) * x[i];
    }
    return true;
  };
  return problem;
}

/// Residuals over n values of a straight line through the origin in exp(c): the cost is a parabola
/// in k = exp(c), so that the profile of c ends at the logarithms of the ends of the interval of k.
TEST(Profile, IsExactWhereTheLinearisedIntervalIsNot) {
  const std::vector<double> x{1, 2, 3, 4, 5}, y{1.4, 1.3, 4.5, 3.1, 6.9};
  const LeastSquares problem = exponential_line(x, y, {"c", "1", 0.3, -kInfinity, kInfinity});
  Calibration fit = minimise(problem, "line");
  add_profiles(problem, fit);
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += x[i] * x[i];
    xy += x[i] * y[i];
    yy += y[i] * y[i];
  }
  const double k = xy / xx, s = std::sqrt((yy - k * xy) / 4);
  const double half = 2.776445 * s / std::sqrt(xx);  // Student's t of 4 at 95 %
  EXPECT_NEAR(fit.estimates[0].profile_low, std::log(k - half), 2e-4);
  EXPECT_NEAR(fit.estimates[0].profile_high, std::log(k + half), 2e-4);
  EXPECT_GT(fit.estimates[0].high - fit.estimates[0].profile_high,
            0.01);  // the linearised one is not
}

/// Where the constant is a logarithm, a warning has the ends of what is named: those of k.
TEST(Profile, WarnsInTheUnitOfWhatIsNamed) {
  const LeastSquares problem =
      exponential_line({1, 2, 3, 4, 5}, {0.2, 2.6, 0.9, 6.1, 4},
                       {"time", "s", 0, -kInfinity, kInfinity, true, true});
  Calibration fit = minimise(problem, "line");
  add_profiles(problem, fit);
  // k = 52.5/55 and s^2 = (60.82 - 52.5^2/55)/4 by hand, and Student's t of 4 at 95 %: 0.342
  // to 1.567.
  EXPECT_THAT(fit.warnings,
              Contains(HasSubstr("time is not symmetric: its profile goes from 0.342")));
}

/// A linear problem of two correlated constants: profile and linearised interval are the same.
TEST(Profile, IsTheLinearisedIntervalOfALinearProblem) {
  const std::vector<double> y{0.3, 1.1, 1.4, 2.6, 2.7, 4.1};
  LeastSquares problem;
  problem.constants = {{"a", "1", 0, -100, 100}, {"b", "1", 0, -100, 0.9}};
  problem.residuals = y.size();
  problem.model = [&](const double* c, double* r, double* J) {
    for (std::size_t i = 0; i < y.size(); ++i) {
      const auto x = static_cast<double>(i);
      r[i] = c[0] + c[1] * x - y[i];
      if (J != nullptr) {
        J[2 * i] = 1;
        J[2 * i + 1] = x;
      }
    }
    return true;
  };
  Calibration fit = minimise(problem, "line");
  add_profiles(problem, fit);
  const Estimate &a = fit.estimates[0], &b = fit.estimates[1];
  EXPECT_NEAR(a.profile_low, a.low, 1e-3 * (a.high - a.low));
  EXPECT_NEAR(a.profile_high, a.high, 1e-3 * (a.high - a.low));
  EXPECT_NEAR(b.profile_low, b.low, 1e-3 * (b.high - b.low));
  EXPECT_GT(b.high, 0.9);
  EXPECT_EQ(b.profile_high, 0.9);  // its bound
}

/// Two constants of which only the product acts: each alone can be anything.
TEST(Profile, SaysWhatTheDataDoNotBound) {
  LeastSquares problem;
  const double infinity = std::numeric_limits<double>::infinity();
  problem.constants = {{"a", "1", 1, -infinity, infinity}, {"b", "1", 0.9, 0.5, infinity}};
  problem.residuals = 4;
  problem.model = [&](const double* c, double* r, double* J) {
    for (std::size_t i = 0; i < 4; ++i) {
      const double x = 1 + static_cast<double>(i);
      r[i] = c[0] * c[1] * x - 2 * x - (i % 2 == 0 ? 0.1 : -0.1);
      if (J != nullptr) {
        J[2 * i] = c[1] * x;
        J[2 * i + 1] = c[0] * x;
      }
    }
    return true;
  };
  Calibration fit = minimise(problem, "product");
  add_profiles(problem, fit);
  // The product is 2 + sum(noise x)/sum(x x), known to t s/sqrt(sum x x) with two degrees of
  // freedom.
  double xx = 0, noise_x = 0, squares = 0;
  for (int i = 0; i < 4; ++i) {
    xx += (1 + i) * (1 + i);
    noise_x += (1 + i) * (i % 2 == 0 ? 0.1 : -0.1);
  }
  for (int i = 0; i < 4; ++i) {
    const double r = noise_x / xx * (1 + i) - (i % 2 == 0 ? 0.1 : -0.1);
    squares += r * r;
  }
  const double high = 2 + noise_x / xx + 4.302653 * std::sqrt(squares / 2 / xx);
  EXPECT_NEAR(fit.estimates[0].profile_high, high / 0.5, 1e-3);  // b at its bound
  EXPECT_NEAR(fit.estimates[0].profile_low, 0, 1e-3);            // any b however large
  EXPECT_EQ(fit.estimates[1].profile_low, 0.5);
  EXPECT_TRUE(std::isinf(fit.estimates[1].profile_high));
  EXPECT_THAT(fit.warnings, Contains(HasSubstr("b is not bounded by the data")));
}

/// The points of a profile of a linear problem lie on its parabola: one at each end.
TEST(Profile, HasThePointsThatItWentThrough) {
  LeastSquares problem;
  problem.constants = {{"k", "1", 1, -10, 10}};
  problem.residuals = 4;
  problem.model = [](const double* c, double* r, double* J) {
    for (int i = 0; i < 4; ++i) {
      r[i] = c[0] * (1 + i) - 2 * (1 + i) - (i % 2 == 0 ? 0.1 : -0.1);
      if (J != nullptr) J[i] = 1 + i;
    }
    return true;
  };
  Calibration fit = minimise(problem, "line");
  add_profiles(problem, fit, {.of = {}, .between = 3});
  const Estimate& e = fit.estimates[0];
  ASSERT_GE(e.profile.size(), 9U);
  EXPECT_TRUE(std::is_sorted(e.profile.begin(), e.profile.end()));
  for (const auto& [value, rise] : e.profile)
    EXPECT_NEAR(rise, std::pow((value - e.value) / (e.high - e.value), 2), 1e-5);
}

/// The data would have the first of two constants, which share no residual, below its bound. From
/// there the cost of n residuals rises as n/2 ((a + d)^2 - d^2), d the distance to what they would
/// have; the interval of the other constant ends at a rise of z^2/2.
TEST(Profile, IsOneSidedAtABound) {
  constexpr int kEach = 4;
  constexpr double kDistance = 0.2, kNormal = 1.959964;
  LeastSquares problem;
  problem.constants = {{"a", "1", 1, 0, 10, true}, {"b", "1", 0, -10, 10, true}};
  problem.residuals = 2 * kEach;
  problem.known_scatter = true;
  problem.model = [](const double* c, double* r, double* J) {
    for (int i = 0; i < 2 * kEach; ++i) {
      r[i] = i < kEach ? c[0] + kDistance : c[1] - 1;
      if (J == nullptr) continue;
      J[2 * i] = i < kEach ? 1 : 0;
      J[2 * i + 1] = i < kEach ? 0 : 1;
    }
    return true;
  };
  Calibration fit = minimise(problem, "two");
  ASSERT_TRUE(fit.estimates[0].at_bound);
  add_profiles(problem, fit);
  EXPECT_TRUE(std::isnan(fit.estimates[0].profile_high));
  add_profiles(problem, fit, {.of = {0}, .at_bounds = true});
  EXPECT_EQ(fit.estimates[0].profile_low, fit.estimates[0].value);
  const double end = std::sqrt(kNormal * kNormal / kEach + kDistance * kDistance) - kDistance;
  EXPECT_NEAR(fit.estimates[0].profile_high, end, 1e-3 * end);
  EXPECT_THAT(fit.warnings, Contains(HasSubstr("a is determined from above alone")));
}

/// Values that differ by less than their noise, from one end of the range to the other.
TEST(Profile, SaysWhereItReachesABound) {
  LeastSquares problem;
  problem.constants = {{"a", "1", 1, 0, 10}};
  problem.residuals = 4;
  problem.known_scatter = true;
  double best = 9.8;
  problem.model = [&](const double* c, double* r, double* J) {
    for (int i = 0; i < 4; ++i) {
      r[i] = c[0] - best;
      if (J != nullptr) J[i] = 1;
    }
    return true;
  };
  Calibration fit = minimise(problem, "near the end");
  add_profiles(problem, fit);
  EXPECT_THAT(fit.warnings, Contains(HasSubstr("a is not determined from above")));
  best = 5;
  const auto model = problem.model;
  problem.model = [&](const double* c, double* r, double* J) {
    model(c, r, J);
    for (int i = 0; i < 4; ++i) r[i] *= 0.01;
    for (int i = 0; i < 4 && J != nullptr; ++i) J[i] *= 0.01;
    return true;
  };
  fit = minimise(problem, "no data");
  add_profiles(problem, fit);
  EXPECT_THAT(fit.warnings, Contains(HasSubstr("a is not determined between its bounds")));
  best = 20;
  fit = minimise(problem, "beyond");
  ASSERT_TRUE(fit.estimates[0].at_bound);
}

}  // namespace
}  // namespace palpate::calibrate
