// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/correlated_noise.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "fitting/measurement/records/statistics.hpp"

namespace palpate::calibrate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kMostCorrelated = 0.98;

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The matrices of the header, applied without being formed.
class Series {
 public:
  explicit Series(const std::vector<std::size_t>& lengths) {
    for (const std::size_t length : lengths) lengths_.push_back(static_cast<Index>(length));
  }

  Index members() const {
    Index sum = 0;
    for (const Index m : lengths_) sum += m;
    return sum;
  }
  Index pairs() const {
    Index sum = 0;
    for (const Index m : lengths_) sum += std::max<Index>(0, m - 1);
    return sum;
  }

  /// V x: each entry of a series gets the r^k-weighted ones before and after it.
  MatrixXd correlated(const MatrixXd& x, double rho) const {
    MatrixXd out = x;
    Index first = 0;
    for (const Index m : lengths_) {
      MatrixXd before = x.middleRows(first, m), after = before;
      for (Index i = 1; i < m; ++i) before.row(i) += rho * before.row(i - 1);
      for (Index i = m - 1; i > 0; --i) after.row(i - 1) += rho * after.row(i);
      out.middleRows(first, m) = before + after - x.middleRows(first, m);
      first += m;
    }
    return out;
  }

  /// A x, with A half of each neighbour: x . A x is the sum over the pairs.
  MatrixXd neighbours(const MatrixXd& x) const {
    MatrixXd out = MatrixXd::Zero(x.rows(), x.cols());
    Index first = 0;
    for (const Index m : lengths_) {
      for (Index i = first; i + 1 < first + m; ++i) {
        out.row(i) += 0.5 * x.row(i + 1);
        out.row(i + 1) += 0.5 * x.row(i);
      }
      first += m;
    }
    return out;
  }

  /// D x: what belongs to a series.
  MatrixXd within(const MatrixXd& x) const {
    MatrixXd out = x;
    out.bottomRows(x.rows() - members()).setZero();
    return out;
  }

  /// Sum of the squares of all entries of V.
  double squares(double rho, Index rows) const {
    auto sum = static_cast<double>(rows);
    for (const Index m : lengths_)
      for (Index k = 1; k < m; ++k)
        sum += 2 * static_cast<double>(m - k) * std::pow(rho, 2 * static_cast<double>(k));
    return sum;
  }

 private:
  std::vector<Index> lengths_;
};

/// Traces over the residuals M e of noise e with covariance V, M = I - Q Q^T.
class FittedNoise {
 public:
  /// Without a column, where all constants are at their bounds, Q is a column of zeros: M = I.
  FittedNoise(const Series& series, const MatrixXd& Q)
      : series_(series),
        Q_(Q.cols() > 0 ? Q : MatrixXd(MatrixXd::Zero(Q.rows(), 1))),
        AQ_(series.neighbours(Q_)),
        DQ_(series.within(Q_)) {}

  /// tr(A M V M) / tr(D M V M): the lag-one correlation that residuals are expected to have.
  double expected_lag_one(double rho) const {
    const MatrixXd VQ = series_.correlated(Q_, rho), QVQ = Q_.transpose() * VQ;
    const double above = rho * static_cast<double>(series_.pairs()) -
                         2 * VQ.cwiseProduct(AQ_).sum() + (QVQ * (Q_.transpose() * AQ_)).trace();
    const double below = static_cast<double>(series_.members()) - 2 * VQ.cwiseProduct(DQ_).sum() +
                         (QVQ * (Q_.transpose() * DQ_)).trace();
    return below > 0 ? above / below : 0;
  }

  /// Standard deviation of that correlation for independent noise, of r = a/b to first order:
  /// var(e . M B M e) = 2 tr((M B M)^2) with B = A - r D.
  double deviation_if_independent() const {
    const double ratio = expected_lag_one(0);
    const MatrixXd BQ = AQ_ - ratio * DQ_;
    const double squares = 0.5 * static_cast<double>(series_.pairs()) +
                           ratio * ratio * static_cast<double>(series_.members()) -
                           2 * BQ.squaredNorm() + (Q_.transpose() * BQ).squaredNorm();
    const double below = static_cast<double>(series_.members()) - Q_.cwiseProduct(DQ_).sum();
    return below > 0 ? std::sqrt(2 * std::max(0.0, squares)) / below : 0;
  }

  /// tr(M V M): the expected sum of the squares of the residuals for noise of unit variance.
  double expected_squares(double rho) const {
    return static_cast<double>(Q_.rows()) - Q_.cwiseProduct(series_.correlated(Q_, rho)).sum();
  }

  /// Degrees of freedom of the chi-squared variable with the mean and variance of that sum.
  double freedom(double rho) const {
    const MatrixXd VQ = series_.correlated(Q_, rho);
    const double variance = series_.squares(rho, Q_.rows()) - 2 * VQ.squaredNorm() +
                            (Q_.transpose() * VQ).squaredNorm();
    const double mean = expected_squares(rho);
    return variance > 0 ? std::max(1.0, mean * mean / variance) : 1;
  }

 private:
  const Series& series_;
  MatrixXd Q_;
  MatrixXd AQ_, DQ_;
};

MatrixXd orthonormal_basis(const MatrixXd& columns) {
  if (columns.cols() == 0) return columns;
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(columns);
  return qr.householderQ() * MatrixXd::Identity(columns.rows(), qr.rank());
}

/// The correlation of the noise whose residuals are expected to look like these.
double noise_correlation(const FittedNoise& noise, double seen) {
  if (noise.expected_lag_one(0) >= seen) return 0;
  if (noise.expected_lag_one(kMostCorrelated) <= seen) return kMostCorrelated;
  double low = 0, high = kMostCorrelated;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (noise.expected_lag_one(middle) < seen ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

CorrelatedNoise correlated_noise(const std::vector<double>& J, std::size_t columns,
                                 const std::vector<double>& r,
                                 const std::vector<std::size_t>& lengths) {
  CorrelatedNoise result;
  const Series series(lengths);
  const auto rows = static_cast<Index>(r.size());
  const Eigen::Map<const RowMajor> jacobian(J.data(), rows, static_cast<Index>(columns));
  const Eigen::Map<const VectorXd> residual(r.data(), rows);
  const MatrixXd Q = orthonormal_basis(jacobian);
  const FittedNoise noise(series, Q);
  const double squares = residual.squaredNorm();
  result.freedom = std::max<double>(1, static_cast<double>(rows - jacobian.cols()));
  result.scatter = std::sqrt(squares / result.freedom);
  const double own = series.within(residual).squaredNorm();
  const double deviation = noise.deviation_if_independent();
  if (!(own > 0) || !(deviation > 0)) return result;
  result.lag_one = residual.dot(series.neighbours(residual).col(0)) / own;
  result.durbin_watson = 0;
  Index first = 0;
  for (const std::size_t length : lengths) {
    const auto m = static_cast<Index>(length);
    for (Index i = first; i + 1 < first + m; ++i)
      result.durbin_watson += std::pow(residual[i + 1] - residual[i], 2) / own;
    first += m;
  }
  const double one_in_twenty = measured::normal_quantile(0.9);  // one side of a standard normal
  result.significant = result.lag_one - noise.expected_lag_one(0) > one_in_twenty * deviation;
  result.autocorrelation = noise_correlation(noise, result.lag_one);
  if (!result.significant) return result;
  result.scatter = std::sqrt(squares / noise.expected_squares(result.autocorrelation));
  result.freedom = noise.freedom(result.autocorrelation);
  const RowMajor meat = jacobian.transpose() * series.correlated(jacobian, result.autocorrelation);
  result.meat.assign(meat.data(), meat.data() + meat.size());
  return result;
}

}  // namespace palpate::calibrate
