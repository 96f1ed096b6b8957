// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/correlated_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palpate::measured {
namespace {

/// Mean and slope of noise of unit variance whose neighbours correlate by r.
ErrorEstimate errors_of(double r, unsigned seed, std::size_t count, Eigen::Vector2d& constants) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal(0, 1);
  const auto n = static_cast<Eigen::Index>(count);
  Eigen::MatrixXd J(n, 2);
  Eigen::VectorXd y(n);
  double noise = normal(engine);
  for (Eigen::Index i = 0; i < n; ++i) {
    J(i, 0) = 1;
    J(i, 1) = 2 * static_cast<double>(i) / static_cast<double>(n - 1) - 1;
    y[i] = noise;
    noise = r * noise + std::sqrt(1 - r * r) * normal(engine);
  }
  constants = (J.transpose() * J).inverse() * J.transpose() * y;
  return estimate_errors(J, y - J * constants, {count});
}

/// The stated covariance is that of many series, with and without correlation.
TEST(CorrelatedErrors, CovarianceIsThatOfManySeries) {
  for (const double r : {0.0, 0.5, 0.85}) {
    constexpr int kTrials = 500;
    double mean = 0, slope = 0, stated_mean = 0, stated_slope = 0, deviation = 0;
    for (unsigned seed = 0; seed < kTrials; ++seed) {
      Eigen::Vector2d constants;
      const ErrorEstimate e = errors_of(r, seed, 200, constants);
      mean += constants[0] * constants[0] / kTrials;
      slope += constants[1] * constants[1] / kTrials;
      stated_mean += e.covariance(0, 0) / kTrials;
      stated_slope += e.covariance(1, 1) / kTrials;
      deviation += e.deviation * e.deviation / kTrials;
    }
    EXPECT_NEAR(stated_mean / mean, 1, 0.25) << r;
    EXPECT_NEAR(stated_slope / slope, 1, 0.25) << r;
    EXPECT_NEAR(deviation, 1, 0.1) << r;
  }
}

TEST(CorrelatedErrors, ChanceIsTakenForNoCorrelation) {
  int none = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    Eigen::Vector2d constants;
    if (errors_of(0, seed, 100, constants).autocorrelation == 0) ++none;
  }
  EXPECT_NEAR(none / 400.0, 0.95, 0.035);  // three standard deviations of the binomial
}

}  // namespace
}  // namespace palpate::measured
