// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/correlated_errors.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "fitting/measurement/autoregressive.hpp"
#include "fitting/measurement/records/statistics.hpp"

namespace palpate::measured {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kMostCorrelated = 0.98;

struct LagOne {
  double seen = 0;
  double pairs = 0;
};

LagOne lag_one(const VectorXd& residual, const std::vector<std::size_t>& stretches) {
  LagOne lag;
  double products = 0;
  Index first = 0;
  for (const std::size_t length : stretches) {
    const auto m = static_cast<Index>(length);
    for (Index i = first; i + 1 < first + m; ++i) products += residual[i] * residual[i + 1];
    lag.pairs += std::max(0.0, static_cast<double>(m) - 1);
    first += m;
  }
  const double squares = residual.squaredNorm();
  lag.seen = squares > 0 ? products / squares : 0;
  return lag;
}

/// The expected lag-one correlation of residuals from which `columns` smooth columns were fitted:
/// on those V acts as (1 + r)/(1 - r).
double expected_lag_one(double r, double rows, double pairs, double columns) {
  const double taken = std::min((1 + r) / (1 - r) * columns, 0.5 * rows);
  return (r * pairs - taken) / (rows - taken);
}

double noise_correlation(const LagOne& lag, double rows, double columns) {
  constexpr double kOneSide = 0.9;  // one in twenty on the upper side
  const double chance = expected_lag_one(0, rows, lag.pairs, columns);
  if (lag.seen - chance <= normal_quantile(kOneSide) / std::sqrt(rows)) return 0;
  if (expected_lag_one(kMostCorrelated, rows, lag.pairs, columns) <= lag.seen) {
    return kMostCorrelated;
  }
  double low = 0, high = kMostCorrelated;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (expected_lag_one(middle, rows, lag.pairs, columns) < lag.seen ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

ErrorEstimate estimate_errors(const MatrixXd& J, const VectorXd& residual,
                              const std::vector<std::size_t>& stretches) {
  const auto rows = static_cast<double>(J.rows()), columns = static_cast<double>(J.cols());
  ErrorEstimate estimate;
  estimate.autocorrelation = noise_correlation(lag_one(residual, stretches), rows, columns);
  const MatrixXd inverse = (J.transpose() * J).ldlt().solve(MatrixXd::Identity(J.cols(), J.cols()));
  const MatrixXd shape = inverse * J.transpose() *
                         fitting::autoregressive_product(J, estimate.autocorrelation, stretches) *
                         inverse;
  const double freedom = rows - (shape * (J.transpose() * J)).trace();  // tr((J^T J)^-1 J^T V J)
  const double variance = residual.squaredNorm() / std::max(freedom, 1.0);
  estimate.deviation = std::sqrt(variance);
  estimate.covariance = variance * shape;
  return estimate;
}

}  // namespace palpate::measured
