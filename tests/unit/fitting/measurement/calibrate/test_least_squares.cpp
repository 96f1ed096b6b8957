// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "fitting/measurement/calibrate/correlated_noise.hpp"
#include "fitting/measurement/calibrate/least_squares.hpp"

namespace palpate::calibrate {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// Residuals over n values of a straight line through the origin in exp(c): the cost is a parabola
/// in k = exp(c), so that the profile of c ends at the logarithms of the ends of the interval of k.
TEST(Profile, IsExactWhereTheLinearisedIntervalIsNot) {
  const std::vector<double> x{1, 2, 3, 4, 5}, y{1.4, 1.3, 4.5, 3.1, 6.9};
  LeastSquares problem;
  const double infinity = std::numeric_limits<double>::infinity();
  problem.constants = {{"c", "1", 0.3, -infinity, infinity}};
  problem.residuals = x.size();
  problem.model = [&](const double* c, double* r, double* J) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      r[i] = std::exp(c[0]) * x[i] - y[i];
      if (J != nullptr) J[i] = std::exp(c[0]) * x[i];
    }
    return true;
  };
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

/// A linear problem of two correlated constants: profile and linearised interval are the same.
TEST(Profile, OfALinearProblemIsTheLinearisedInterval) {
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

/// A line through the origin with noise that remembers: y_i = k x_i + e_i, e_i = r e_i-1 + ...
struct Line {
  std::vector<double> x, y;
  std::vector<std::size_t> series;

  LeastSquares problem(bool in_series) const {
    LeastSquares p;
    p.constants = {{"k", "1", 1, -1e9, 1e9}};
    p.residuals = x.size();
    if (in_series) p.series = series;
    p.model = [this](const double* c, double* r, double* J) {
      for (std::size_t i = 0; i < x.size(); ++i) {
        r[i] = c[0] * x[i] - y[i];
        if (J != nullptr) J[i] = x[i];
      }
      return true;
    };
    return p;
  }
};

Line remembering_line(double slope, double rho, std::mt19937& engine) {
  constexpr int kCurves = 3, kPoints = 20;
  std::normal_distribution<double> normal(0, 1);
  Line line;
  for (int c = 0; c < kCurves; ++c) {
    line.series.push_back(kPoints);
    double e = normal(engine);
    for (int i = 1; i <= kPoints; ++i) {
      line.x.push_back(0.1 * i);
      line.y.push_back(slope * line.x.back() + 0.2 * e);
      e = rho * e + std::sqrt(1 - rho * rho) * normal(engine);
    }
  }
  return line;
}

/// Of a line through the origin everything is known in closed form: the variance of its slope is
/// s^2 sum_ij x_i V_ij x_j / (sum x^2)^2. The intervals must have that width in the mean, and hold
/// the truth as often as they say, where those for independent noise do not.
TEST(CorrelatedNoise, IntervalsOfALineCoverTheTruth) {
  constexpr int kTrials = 400;
  constexpr double kSlope = 2, kRho = 0.8;
  std::mt19937 engine(11);
  int inside = 0, inside_if_independent = 0, told = 0;
  double variance = 0, correlation = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Line line = remembering_line(kSlope, kRho, engine);
    const Calibration fit = minimise(line.problem(true), "line");
    const Calibration plain = minimise(line.problem(false), "line");
    const Estimate &e = fit.estimates[0], &p = plain.estimates[0];
    inside += std::abs(e.value - kSlope) <= e.high - e.value;
    inside_if_independent += std::abs(p.value - kSlope) <= p.high - p.value;
    told += fit.correlated;
    variance += e.standard_error * e.standard_error / kTrials;
    correlation += fit.autocorrelation / kTrials;
    if (!fit.correlated) continue;
    EXPECT_THAT(fit.warnings, Contains(HasSubstr("residuals of neighbouring points are alike")));
    EXPECT_NEAR(fit.correlation_widening, (e.high - e.value) / (p.high - p.value), 1e-9);
  }
  const Line line = remembering_line(kSlope, kRho, engine);
  double xx = 0, xVx = 0;
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    xx += line.x[i] * line.x[i];
    for (std::size_t j = i / 20 * 20; j < i / 20 * 20 + 20; ++j) {
      const double apart = std::abs(static_cast<double>(i) - static_cast<double>(j));
      xVx += line.x[i] * line.x[j] * std::pow(kRho, apart);
    }
  }
  const double expected = 0.04 * xVx / (xx * xx);
  EXPECT_NEAR(variance / expected, 1, 0.15);
  EXPECT_NEAR(correlation, kRho, 0.05);
  EXPECT_GE(told, kTrials - 4);
  EXPECT_GE(inside, 360);  // 380 expected of a known correlation, three standard deviations are 13
  EXPECT_LT(inside_if_independent, 280);
}

/// Independent noise must not be taken for a misfit more often than one time in twenty.
TEST(CorrelatedNoise, IndependentNoiseIsLeftAlone) {
  constexpr int kTrials = 1000;
  std::mt19937 engine(12);
  int told = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Line line = remembering_line(2, 0, engine);
    told += minimise(line.problem(true), "line").correlated;
  }
  EXPECT_GT(told, 50 - 21);  // three standard deviations of 1000 draws are 21
  EXPECT_LT(told, 50 + 21);
}

/// Dense algebra beside the recursions: V, M and the traces by their definitions.
TEST(CorrelatedNoise, IsTheMomentEstimateOfItsDefinition) {
  const std::vector<double> J{1, 0.2, 1, 0.5, 1, 1.1, 1, 1.3, 1, 2.2, 1, 2.4,
                              1, 3.5, 1, 0.4, 1, 0.9, 1, 1.9, 1, 2.7, 1, 0.1};
  const std::vector<double> r{0.5, 0.6, 0.2, 0.1, -0.4, -0.6, -0.3, 0.1, 0.4, 0.5, 0.0, 0.9};
  const CorrelatedNoise found = correlated_noise(J, 2, r, {6, 5});  // the last is on its own
  constexpr std::array kFirstOfPairs{0U, 1U, 2U, 3U, 4U, 6U, 7U, 8U, 9U};
  double pairs = 0, own = 0, steps = 0;
  for (const std::size_t i : kFirstOfPairs) {
    pairs += r[i] * r[i + 1];
    steps += (r[i + 1] - r[i]) * (r[i + 1] - r[i]);
  }
  for (std::size_t i = 0; i < 11; ++i) own += r[i] * r[i];
  EXPECT_NEAR(found.lag_one, pairs / own, 1e-12);
  EXPECT_NEAR(found.durbin_watson, steps / own, 1e-12);
  ASSERT_TRUE(found.significant);
  ASSERT_LT(found.autocorrelation, 0.97);  // below its bound, where it solves its equation
  constexpr std::size_t n = 12;
  using Dense = std::array<std::array<double, n>, n>;
  const auto product = [](const Dense& a, const Dense& b) {
    Dense c{};
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t k = 0; k < n; ++k) c[i][j] += a[i][k] * b[k][j];
    return c;
  };
  double a = 0, b = 0, d = 0;  // J^T J
  for (std::size_t i = 0; i < n; ++i) {
    a += J[2 * i] * J[2 * i];
    b += J[2 * i] * J[2 * i + 1];
    d += J[2 * i + 1] * J[2 * i + 1];
  }
  Dense M{}, V{};
  const auto series = [](std::size_t i) { return i < 6 ? 0 : i < 11 ? 1 : 2; };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const double *p = &J[2 * i], *q = &J[2 * j];
      M[i][j] =
          (i == j ? 1 : 0) -
          (d * p[0] * q[0] - b * (p[0] * q[1] + p[1] * q[0]) + a * p[1] * q[1]) / (a * d - b * b);
      const double apart = std::abs(static_cast<double>(i) - static_cast<double>(j));
      if (series(i) == series(j)) V[i][j] = std::pow(found.autocorrelation, apart);
    }
  }
  const Dense W = product(product(M, V), M), WW = product(W, W);
  double lag = 0, within = 0, all = 0, squares = 0, sum = 0;
  for (const std::size_t i : kFirstOfPairs) lag += W[i][i + 1];
  for (std::size_t i = 0; i < n; ++i) {
    if (i < 11) within += W[i][i];
    all += W[i][i];
    squares += WW[i][i];
    sum += r[i] * r[i];
  }
  EXPECT_NEAR(lag / within, found.lag_one, 1e-9);
  EXPECT_NEAR(found.scatter, std::sqrt(sum / all), 1e-9);
  EXPECT_NEAR(found.freedom, std::max(1.0, all * all / squares), 1e-9);
  double meat = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) meat += J[2 * i] * V[i][j] * J[2 * j + 1];
  EXPECT_NEAR(found.meat[1], meat, 1e-9);
}

}  // namespace
}  // namespace palpate::calibrate
