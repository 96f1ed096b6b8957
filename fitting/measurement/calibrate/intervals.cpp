// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/intervals.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "fitting/measurement/calibrate/correlated_noise.hpp"
#include "fitting/measurement/records/statistics.hpp"
#include "format/numbers.hpp"

namespace palpate::calibrate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Inverse of J^T J, and the square root of the ratio of its eigenvalues when it is scaled to a
/// unit diagonal. Directions that the data do not see get a variance beyond any use, not infinity.
MatrixXd inverse_normal(const RowMajor& J, double& condition) {
  constexpr double kUnseen = 1e-16;
  const MatrixXd normal = J.transpose() * J;
  const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt();
  const Eigen::VectorXd over = scale.unaryExpr([](double s) { return s > 0 ? 1 / s : 0; });
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(over.asDiagonal() * normal *
                                                      over.asDiagonal());
  const Eigen::VectorXd& values = eigen.eigenvalues();  // ascending
  const double largest = values[values.size() - 1];
  condition = values[0] > 0 ? std::sqrt(largest / values[0]) : kInfinity;
  const MatrixXd rows = scale.cwiseInverse().asDiagonal() * eigen.eigenvectors();
  return rows * values.cwiseMax(kUnseen * largest).cwiseInverse().asDiagonal() * rows.transpose();
}

/// Whether residuals over their stated uncertainty scatter more than chance lets them: a scatter of
/// one with f degrees of freedom is itself uncertain by 1/sqrt(2 f).
bool is_unexplained(const Calibration& result) {
  constexpr double kDeviations = 3;
  return result.freedom > 0 &&
         result.scatter > 1 + kDeviations / std::sqrt(2.0 * result.effective_freedom);
}

double quantile(const LeastSquares& problem, bool estimated, int freedom, double effective) {
  if (freedom <= 0) return kInfinity;
  return estimated ? measured::student_quantile(problem.confidence, effective)
                   : measured::normal_quantile(problem.confidence);
}

void take(const CorrelatedNoise& noise, Calibration& result) {
  result.scatter = noise.scatter;
  result.effective_freedom = noise.freedom;
  result.lag_one = noise.lag_one;
  result.durbin_watson = noise.durbin_watson;
  result.correlated = noise.significant;
  result.autocorrelation = noise.significant ? noise.autocorrelation : 0;
}

}  // namespace

void add_intervals(const LeastSquares& problem, const std::vector<double>& J,
                   const std::vector<double>& r, Calibration& result) {
  const std::size_t columns = problem.constants.size();
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < columns; ++i)
    if (!result.estimates[i].at_bound) free.push_back(i);
  result.freedom = static_cast<int>(problem.residuals) - static_cast<int>(free.size());
  std::vector<double> own;
  for (std::size_t row = 0; row < problem.residuals; ++row)
    for (const std::size_t i : free) own.push_back(J[row * columns + i]);
  const CorrelatedNoise noise = correlated_noise(own, free.size(), r, problem.series);
  take(noise, result);
  result.correlation.assign(columns, std::vector<double>(columns, std::nan("")));
  result.widened = problem.known_scatter && is_unexplained(result);
  if (free.empty()) return;
  const auto n = static_cast<Index>(free.size());
  const Eigen::Map<const RowMajor> jacobian(own.data(), static_cast<Index>(problem.residuals), n);
  const MatrixXd unit = inverse_normal(jacobian, result.condition);
  const bool estimated = !problem.known_scatter || result.widened;
  MatrixXd covariance = unit;
  if (noise.significant) {
    // Only the part of a stated scatter that the residuals show is known to be correlated.
    const double part = estimated ? 1 : std::min(1.0, noise.scatter * noise.scatter);
    const Eigen::Map<const RowMajor> meat(noise.meat.data(), n, n);
    covariance = (1 - part) * unit + part * (unit * meat * unit);
  }
  const double s = estimated ? result.scatter : 1;
  const double t = quantile(problem, estimated, result.freedom, result.effective_freedom);
  // What the half widths would be over unit_error if the residuals were taken for independent.
  const double squares = std::inner_product(r.begin(), r.end(), r.begin(), 0.0);
  const double plain = (estimated ? std::sqrt(squares / std::max(1, result.freedom)) : 1) *
                       quantile(problem, estimated, result.freedom, result.freedom);
  for (Index i = 0; i < n; ++i) {
    Estimate& e = result.estimates[free[static_cast<std::size_t>(i)]];
    e.unit_error = std::sqrt(unit(i, i));
    e.standard_error = s * std::sqrt(covariance(i, i));
    e.low = e.value - t * e.standard_error;
    e.high = e.value + t * e.standard_error;
    if (noise.significant && plain > 0 && std::isfinite(plain)) {
      result.correlation_widening =
          std::max(result.correlation_widening, t * e.standard_error / (plain * e.unit_error));
    }
    for (Index j = 0; j < n; ++j) {
      result.correlation[free[static_cast<std::size_t>(i)]][free[static_cast<std::size_t>(j)]] =
          covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j));
    }
  }
}

}  // namespace palpate::calibrate
