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

/// The inverse of J^T J as a product F F^T, and the square root of the ratio of its eigenvalues
/// when it is scaled to a unit diagonal. Directions that the data do not see get a variance beyond
/// any use, not infinity; a column of zeros gets a row of zeros.
struct InverseNormal {
  MatrixXd factor;
  RowMajor basis;  ///< U of J = U S V^T: F is V S^-1
  double condition = 1;
  std::vector<bool> seen;  ///< whether the constant acts on any residual

  explicit InverseNormal(const RowMajor& J) {
    constexpr double kUnseen = 1e-12;  // of the largest singular value
    const Eigen::VectorXd scale = J.colwise().norm();
    Eigen::VectorXd over(scale.size());
    for (Index i = 0; i < scale.size(); ++i) {
      seen.push_back(scale[i] > 0);
      over[i] = scale[i] > 0 ? 1 / scale[i] : 0;
    }
    const Eigen::JacobiSVD<MatrixXd, Eigen::ColPivHouseholderQRPreconditioner> svd(
        J * over.asDiagonal(), Eigen::ComputeThinU | Eigen::ComputeThinV);
    const Eigen::VectorXd& values = svd.singularValues();  // descending
    const double largest = values[0], least = values[values.size() - 1];
    condition = least > 0 ? largest / least : kInfinity;
    const Eigen::VectorXd inverse = values.unaryExpr(
        [&](double v) { return largest > 0 ? 1 / std::max(v, kUnseen * largest) : 0; });
    basis = svd.matrixU();
    factor = over.asDiagonal() * svd.matrixV() * inverse.asDiagonal();
  }

  /// Rows whose products are the entries of F meat F^T, with meat = U^T N U of the covariance N of
  /// the noise: a covariance that is made of products has no variance below zero and no correlation
  /// beyond one.
  MatrixXd root_of(const std::vector<double>& meat) const {
    const Eigen::Map<const RowMajor> whole(meat.data(), factor.cols(), factor.cols());
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(whole);
    return factor * eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
  }
};

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
  result.beyond_noise = noise.significant && noise.beyond_noise;
  result.autocorrelation = noise.significant ? noise.autocorrelation : 0;
}

/// Rows whose products are the covariances, of noise of unit scatter.
MatrixXd covariance_root(const InverseNormal& unit, const CorrelatedNoise& noise, bool estimated) {
  MatrixXd whole = unit.root_of(noise.meat);
  // Only the part of a stated scatter that the residuals show is known to be correlated.
  const double part = estimated ? 1 : std::min(1.0, noise.scatter * noise.scatter);
  if (part == 1 || !noise.significant) return whole;
  const MatrixXd independent = unit.root_of(noise.meat_if_independent);
  MatrixXd both(whole.rows(), 2 * whole.cols());
  both << std::sqrt(part) * whole, std::sqrt(1 - part) * independent;
  return both;
}

/// Correlations of the constants `free`, by the rows of the root of their covariance.
void add_correlations(const MatrixXd& root, const std::vector<std::size_t>& free,
                      Calibration& result) {
  for (Index i = 0; i < root.rows(); ++i) {
    for (Index j = 0; j < root.rows(); ++j) {
      const double both = root.row(i).norm() * root.row(j).norm();
      result.correlation[free[static_cast<std::size_t>(i)]][free[static_cast<std::size_t>(j)]] =
          i == j     ? 1
          : both > 0 ? std::clamp(root.row(i).dot(root.row(j)) / both, -1.0, 1.0)
                     : 0;
    }
  }
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
  result.correlation.assign(columns, std::vector<double>(columns, std::nan("")));
  const auto n = static_cast<Index>(free.size());
  const Eigen::Map<const RowMajor> jacobian(own.data(), static_cast<Index>(problem.residuals), n);
  if (free.empty()) {
    take(correlated_noise(own, 0, r, problem.series, problem.deviations), result);
    result.widened = problem.known_scatter && is_unexplained(result);
    return;
  }
  const InverseNormal unit(jacobian);
  result.condition = unit.condition;
  own.assign(unit.basis.data(), unit.basis.data() + unit.basis.size());
  const CorrelatedNoise noise =
      correlated_noise(own, free.size(), r, problem.series, problem.deviations);
  take(noise, result);
  result.widened = problem.known_scatter && is_unexplained(result);
  const bool estimated = !problem.known_scatter || result.widened;
  const MatrixXd root = covariance_root(unit, noise, estimated);
  const MatrixXd independent = unit.root_of(noise.meat_if_independent);
  const double s = estimated ? result.scatter : 1;
  const double t = quantile(problem, estimated, result.freedom, result.effective_freedom);
  // What the half widths would be if the residuals were taken for independent.
  const double squares = std::inner_product(r.begin(), r.end(), r.begin(), 0.0);
  const double plain = (estimated ? std::sqrt(squares / std::max(1, result.freedom)) : 1) *
                       quantile(problem, estimated, result.freedom, result.freedom);
  for (Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    Estimate& e = result.estimates[free[k]];
    const bool known = unit.seen[k] && result.freedom > 0;
    e.unit_error = unit.factor.row(i).norm();
    e.standard_error = known ? s * root.row(i).norm() : kInfinity;
    e.low = known ? e.value - t * e.standard_error : -kInfinity;
    e.high = known ? e.value + t * e.standard_error : kInfinity;
    const double half = plain * independent.row(i).norm();
    if (noise.significant && half > 0 && std::isfinite(half)) {
      result.correlation_widening =
          std::max(result.correlation_widening, t * e.standard_error / half);
    }
  }
  add_correlations(root, free, result);
}

}  // namespace palpate::calibrate
