// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
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

/// Dense algebra beside the recursions: N = D V D, M and the traces by their definitions, at the
/// lag at which the residuals over their deviations are less alike than one half.
TEST(CorrelatedNoise, IsTheMomentEstimateOfItsDefinition) {
  constexpr int n = 12;
  using Dense = Eigen::MatrixXd;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> J(n, 2);
  J << 1, 0.2, 1, 0.5, 1, 1.1, 1, 1.3, 1, 2.2, 1, 2.4, 1, 3.5, 1, 0.4, 1, 0.9, 1, 1.9, 1, 2.7, 1,
      0.1;
  Eigen::VectorXd r(n), d(n);
  r << 0.5, 0.6, 0.2, 0.1, -0.4, -0.6, -0.3, 0.1, 0.4, 0.5, 0.0, 0.9;
  for (const bool alike : {true, false}) {
    d.setOnes();
    if (!alike) d.head(6).setConstant(0.7), d.segment(6, 5).setConstant(1.3);
    const auto values = [](const auto& m) {
      return std::vector<double>(m.data(), m.data() + m.size());
    };
    const CorrelatedNoise found = correlated_noise(values(J), 2, values(r), {6, 5},
                                                   alike ? std::vector<double>{} : values(d));
    const auto series = [](int i) { return i < 6 ? 0 : i < 11 ? 1 : 2; };  // the last is on its own
    const auto pairs = [&](int lag) {
      Dense A = Dense::Zero(n, n);
      for (int i = 0; i + lag < n; ++i)
        if (series(i) == series(i + lag)) A(i, i + lag) = A(i + lag, i) = lag == 0 ? 1 : 0.5;
      A(11, 11) = 0;
      return A;
    };
    const Eigen::VectorXd own = r.cwiseQuotient(d);
    const double squares = own.dot(pairs(0) * own);
    EXPECT_NEAR(found.lag_one, own.dot(pairs(1) * own) / squares, 1e-12);
    ASSERT_TRUE(found.significant);
    ASSERT_FALSE(found.beyond_noise);
    const int lag = own.dot(pairs(1) * own) > 0.5 * squares ? 2 : 1;
    Dense N = Dense::Zero(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        if (series(i) == series(j))
          N(i, j) = d[i] * d[j] * std::pow(found.autocorrelation, std::abs(i - j));
    const Dense M = Dense::Identity(n, n) - J * (J.transpose() * J).inverse() * J.transpose();
    const Dense W = M * N * M, over = Dense(d.cwiseInverse().asDiagonal());
    EXPECT_NEAR((over * pairs(lag) * over * W).trace() / (over * pairs(0) * over * W).trace(),
                own.dot(pairs(lag) * own) / squares, 1e-9);
    EXPECT_NEAR(found.scatter, std::sqrt(r.squaredNorm() / W.trace()), 1e-9);
    EXPECT_NEAR(found.freedom, W.trace() * W.trace() / (W * W).trace(), 1e-9);
    EXPECT_NEAR(found.meat[1], (J.transpose() * N * J)(0, 1), 1e-9);
  }
}

/// The deviation of the lag-one correlation of fitted noise whose variance differs from series to
/// series, against draws: a test that is weighted tenfold is not taken for correlated.
TEST(CorrelatedNoise, OfUnequalWeightsIsLeftAlone) {
  constexpr int kTrials = 1000;
  std::mt19937 engine(13);
  int found = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    Line line = correlated_line(2, 0, engine);
    std::vector<double> deviations;
    for (std::size_t i = 0; i < line.x.size(); ++i) {
      const double weight = i < 20 ? 10 : 1;
      line.x[i] *= weight;
      line.y[i] *= weight;
      deviations.push_back(weight);
    }
    LeastSquares problem = line.problem(true);
    problem.deviations = deviations;
    found += minimise(problem, "line").correlated;
  }
  EXPECT_GT(found, 50 - 21);  // three standard deviations of 1000 draws are 21
  EXPECT_LT(found, 50 + 21);
}

/// A parabola misses x^3 by four half waves that are smoother than noise. However many samples
/// there are, they count for as many as half waves at least: the standard errors are no wider than
/// for four.
TEST(CorrelatedNoise, AMisfitThatIsSmootherThanNoiseIsSaidAndNotInflated) {
  for (const int n : {20, 40, 100}) {
    LeastSquares problem;
    for (const char* name : {"a", "b", "c"}) problem.constants.push_back({name, "1", 0, -9, 9});
    problem.residuals = static_cast<std::size_t>(n);
    problem.series = {problem.residuals};
    problem.model = [n](const double* c, double* r, double* J) {
      for (int i = 0; i < n; ++i) {
        const double x = static_cast<double>(i) / (n - 1);
        r[i] = c[0] + x * (c[1] + x * c[2]) - x * x * x;
        if (J != nullptr) J[3 * i] = 1, J[3 * i + 1] = x, J[3 * i + 2] = x * x;
      }
      return true;
    };
    const Calibration fit = minimise(problem, "parabola");
    EXPECT_TRUE(fit.beyond_noise) << n;
    EXPECT_THAT(fit.warnings, Contains(HasSubstr("more than in any noise")));
    const double scatter = std::sqrt(2 * fit.cost / (n - 3));
    EXPECT_NEAR(fit.scatter, scatter, 1e-6 * scatter);
    for (const Estimate& e : fit.estimates) {
      EXPECT_GT(e.standard_error, scatter * e.unit_error) << n;
      EXPECT_LT(e.standard_error, std::sqrt(n / 4.0) * scatter * e.unit_error) << n;
    }
  }
}

/// Resampling between the samples of a curve adds nothing and takes nothing away: the interval
/// stays what it was, twenty times as many points or not, although neighbours are now all alike.
TEST(CorrelatedNoise, ResampledCurvesKeepTheirIntervals) {
  constexpr int kTrials = 100, kTimes = 20;
  std::mt19937 engine(14);
  double sum = 0;
  int inside = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Line line = correlated_line(2, 0, engine);
    Line dense;
    for (std::size_t c = 0; c < line.series.size(); ++c) {
      const std::size_t first = 20 * c;
      for (std::size_t i = 0; i + kTimes < 20 * kTimes; ++i) {
        const std::size_t at = first + i / kTimes;
        const double part = static_cast<double>(i % kTimes) / kTimes;
        dense.x.push_back((1 - part) * line.x[at] + part * line.x[at + 1]);
        dense.y.push_back((1 - part) * line.y[at] + part * line.y[at + 1]);
      }
      dense.series.push_back(19 * kTimes);
    }
    const Estimate before = minimise(line.problem(true), "line").estimates[0];
    const Calibration after = minimise(dense.problem(true), "line");
    EXPECT_TRUE(after.correlated);
    const Estimate& e = after.estimates[0];
    sum += std::log((e.high - e.low) / (before.high - before.low)) / kTrials;
    inside += e.low <= 2 && 2 <= e.high;
  }
  EXPECT_NEAR(std::exp(sum), 1, 0.35);
  EXPECT_GE(inside, 88);  // 95 expected, three standard deviations are 6.5
}

}  // namespace
}  // namespace palpate::calibrate
