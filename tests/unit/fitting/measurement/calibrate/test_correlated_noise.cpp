// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "fitting/measurement/calibrate/correlated_noise.hpp"
#include "fitting/measurement/calibrate/least_squares.hpp"

namespace palpate::calibrate {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// A line through the origin with correlated noise: y_i = k x_i + e_i, e_i = r e_i-1 + ...
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

Line correlated_line(double slope, double rho, std::mt19937& engine) {
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

/// Everything is known in closed form of a line through the origin: the variance of its slope is
/// s^2 sum_ij x_i V_ij x_j / (sum x^2)^2. The intervals must have that width in the mean, and
/// contain the truth as often as stated, where those for independent noise do not.
TEST(CorrelatedNoise, IntervalsOfALineCoverTheTruth) {
  constexpr int kTrials = 400;
  constexpr double kSlope = 2, kRho = 0.8;
  std::mt19937 engine(11);
  int inside = 0, inside_if_independent = 0, found = 0;
  double variance = 0, correlation = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Line line = correlated_line(kSlope, kRho, engine);
    const Calibration fit = minimise(line.problem(true), "line");
    const Calibration plain = minimise(line.problem(false), "line");
    const Estimate &e = fit.estimates[0], &p = plain.estimates[0];
    inside += std::abs(e.value - kSlope) <= e.high - e.value;
    inside_if_independent += std::abs(p.value - kSlope) <= p.high - p.value;
    found += fit.correlated;
    variance += e.standard_error * e.standard_error / kTrials;
    correlation += fit.autocorrelation / kTrials;
    if (!fit.correlated) continue;
    EXPECT_THAT(fit.warnings, Contains(HasSubstr("residuals of neighbouring points are alike")));
    EXPECT_NEAR(fit.correlation_widening, (e.high - e.value) / (p.high - p.value), 1e-9);
  }
  const Line line = correlated_line(kSlope, kRho, engine);
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
  EXPECT_GE(found, kTrials - 4);
  EXPECT_GE(inside, 360);  // 380 expected of a known correlation, three standard deviations are 13
  EXPECT_LT(inside_if_independent, 280);
}

/// Independent noise must not be taken for a misfit more often than one time in twenty.
TEST(CorrelatedNoise, IndependentNoiseIsLeftAlone) {
  constexpr int kTrials = 1000;
  std::mt19937 engine(12);
  int found = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Line line = correlated_line(2, 0, engine);
    found += minimise(line.problem(true), "line").correlated;
  }
  EXPECT_GT(found, 50 - 21);  // three standard deviations of 1000 draws are 21
  EXPECT_LT(found, 50 + 21);
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
