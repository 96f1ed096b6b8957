// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/correlated_noise.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "fitting/measurement/autoregressive.hpp"
#include "fitting/measurement/records/statistics.hpp"

namespace palpate::calibrate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The most correlation at the lag that is compared: beyond it, noise is hardly told from an
/// offset.
constexpr double kMostCorrelated = 0.98;
/// The lag that is compared is the first at which residuals are less alike than this.
constexpr double kDecorrelated = 0.5;

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The matrices of the header, applied without being formed. D is the diagonal of deviations.
class Series {
 public:
  Series(const std::vector<std::size_t>& lengths, VectorXd deviations)
      : deviations_(std::move(deviations)) {
    for (const std::size_t length : lengths) lengths_.push_back(static_cast<Index>(length));
  }

  const VectorXd& deviations() const { return deviations_; }
  Index members() const { return pairs(0); }
  Index longest() const {
    return lengths_.empty() ? 0 : *std::max_element(lengths_.begin(), lengths_.end());
  }
  /// Pairs of residuals of one series that are `lag` apart.
  Index pairs(Index lag) const {
    Index sum = 0;
    for (const Index m : lengths_) sum += std::max<Index>(0, m - lag);
    return sum;
  }

  /// D V D x: each entry of a series gets the r^k-weighted ones before and after it.
  MatrixXd correlated(const MatrixXd& x, double rho) const {
    return deviations_.asDiagonal() * smeared(deviations_.asDiagonal() * x, rho);
  }

  /// D^-1 A D^-1 x, with A half of each neighbour at the lag: x . A x is the sum over the pairs.
  MatrixXd neighbours(const MatrixXd& x, Index lag) const {
    const MatrixXd scaled = deviations_.cwiseInverse().asDiagonal() * x;
    MatrixXd out = MatrixXd::Zero(x.rows(), x.cols());
    Index first = 0;
    for (const Index m : lengths_) {
      for (Index i = first; i + lag < first + m; ++i) {
        out.row(i) += 0.5 * scaled.row(i + lag);
        out.row(i + lag) += 0.5 * scaled.row(i);
      }
      first += m;
    }
    return deviations_.cwiseInverse().asDiagonal() * out;
  }

  /// D^-1 I D^-1 x, with I what belongs to a series.
  MatrixXd within(const MatrixXd& x) const {
    MatrixXd out = deviations_.cwiseAbs2().cwiseInverse().asDiagonal() * x;
    out.bottomRows(x.rows() - members()).setZero();
    return out;
  }

  /// Sum of the squares of all entries of D V D.
  double squares(double rho) const {
    const VectorXd variances = deviations_.cwiseAbs2();
    return variances.dot(smeared(variances, rho * rho).col(0));
  }

 private:
  /// V x.
  MatrixXd smeared(const MatrixXd& x, double rho) const {
    return fitting::autoregressive_product(x, rho, lengths_);
  }

  std::vector<Index> lengths_;
  VectorXd deviations_;
};

/// Traces over the residuals M e of noise e with covariance D V D, M = I - Q Q^T.
class FittedNoise {
 public:
  /// Without a column, where all constants are at their bounds, Q is a column of zeros: M = I.
  FittedNoise(const Series& series, const MatrixXd& Q)
      : series_(series),
        Q_(Q.cols() > 0 ? Q : MatrixXd(MatrixXd::Zero(Q.rows(), 1))),
        IQ_(series.within(Q_)) {}

  /// tr(A M V M) / tr(I M V M): the correlation that residuals are expected to have at a lag.
  double expected(double rho, Index lag) const {
    const MatrixXd VQ = series_.correlated(Q_, rho), QVQ = Q_.transpose() * VQ;
    const MatrixXd AQ = series_.neighbours(Q_, lag);
    const double above =
        std::pow(rho, static_cast<double>(lag)) * static_cast<double>(series_.pairs(lag)) -
        2 * VQ.cwiseProduct(AQ).sum() + (QVQ * (Q_.transpose() * AQ)).trace();
    const double below = own(rho);
    return below > 0 ? above / below : 0;
  }

  /// Standard deviation of that correlation at lag one for independent noise, of r = a/b to first
  /// order: var(e . M B M e) = 2 |D M B M D|^2 with B = A - r I, where D M D^-1 = I - P R^T.
  double deviation_if_independent() const {
    const double ratio = expected(0, 1);
    const VectorXd& d = series_.deviations();
    const auto B = [&](const MatrixXd& x) -> MatrixXd {
      const MatrixXd scaled = d.asDiagonal() * x;
      return d.asDiagonal() * (series_.neighbours(scaled, 1) - ratio * series_.within(scaled));
    };
    const MatrixXd R = d.cwiseInverse().asDiagonal() * Q_, P = d.asDiagonal() * Q_;
    const MatrixXd G = B(R), S = R.transpose() * G, K = P.transpose() * P, PG = P.transpose() * G;
    const double squares = 0.5 * static_cast<double>(series_.pairs(1)) +
                           ratio * ratio * static_cast<double>(series_.members()) +
                           2 * (K * G.transpose() * G).trace() + 2 * (PG * PG).trace() -
                           4 * B(P).cwiseProduct(G).sum() + 2 * (S * P.transpose() * B(P)).trace() -
                           4 * (K * S * PG).trace() + (K * S * K * S).trace();
    const double below = own(0);
    return below > 0 ? std::sqrt(2 * std::max(0.0, squares)) / below : 0;
  }

  /// tr(M V M): the expected sum of the squares of the residuals for noise of unit variance.
  double expected_squares(double rho) const {
    return series_.deviations().squaredNorm() - Q_.cwiseProduct(series_.correlated(Q_, rho)).sum();
  }

  /// Degrees of freedom of the chi-squared variable with the mean and variance of that sum.
  double freedom(double rho) const {
    const MatrixXd VQ = series_.correlated(Q_, rho);
    const double variance =
        series_.squares(rho) - 2 * VQ.squaredNorm() + (Q_.transpose() * VQ).squaredNorm();
    const double mean = expected_squares(rho);
    return variance > 0 ? std::max(1.0, mean * mean / variance) : 1;
  }

 private:
  /// tr(I M V M)
  double own(double rho) const {
    const MatrixXd VQ = series_.correlated(Q_, rho);
    return static_cast<double>(series_.members()) - 2 * VQ.cwiseProduct(IQ_).sum() +
           (Q_.transpose() * VQ * (Q_.transpose() * IQ_)).trace();
  }

  const Series& series_;
  MatrixXd Q_, IQ_;
};

MatrixXd orthonormal_basis(const MatrixXd& columns) {
  if (columns.cols() == 0) return columns;
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(columns);
  return qr.householderQ() * MatrixXd::Identity(columns.rows(), qr.rank());
}

/// The first lag at which residuals are less alike, within a third of the longest series: smooth
/// residuals are so alike at lag one that it says little of how far they stay so.
Index decorrelated_lag(const Series& series, const VectorXd& r) {
  const double own = r.dot(series.within(r).col(0));
  Index lag = 1;
  while (lag < series.longest() / 3 &&
         r.dot(series.neighbours(r, lag).col(0)) > kDecorrelated * own)
    ++lag;
  return lag;
}

/// The correlation from sample to sample of the noise whose residuals are expected to be this much
/// alike at the lag; none when those of the most correlated noise are less alike.
std::optional<double> noise_correlation(const FittedNoise& noise, double seen, Index lag) {
  double low = 0, high = std::pow(kMostCorrelated, 1 / static_cast<double>(lag));
  if (noise.expected(low, lag) >= seen) return 0;
  if (noise.expected(high, lag) <= seen) return std::nullopt;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (noise.expected(middle, lag) < seen ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// For residuals over their deviations, sum (r_i+1 - r_i)^2 over the series.
double squared_steps(const VectorXd& r, const std::vector<std::size_t>& lengths) {
  double sum = 0;
  Index first = 0;
  for (const std::size_t length : lengths) {
    const auto m = static_cast<Index>(length);
    for (Index i = first; i + 1 < first + m; ++i) sum += std::pow(r[i + 1] - r[i], 2);
    first += m;
  }
  return sum;
}

std::vector<double> numbers_of(const RowMajor& m) {
  return {m.data(), m.data() + m.size()};
}

}  // namespace

CorrelatedNoise correlated_noise(const std::vector<double>& J, std::size_t columns,
                                 const std::vector<double>& r,
                                 const std::vector<std::size_t>& lengths,
                                 const std::vector<double>& deviations) {
  CorrelatedNoise result;
  const auto rows = static_cast<Index>(r.size());
  const Eigen::Map<const RowMajor> jacobian(J.data(), rows, static_cast<Index>(columns));
  const Eigen::Map<const VectorXd> residual(r.data(), rows);
  const VectorXd d = deviations.empty()
                         ? VectorXd(VectorXd::Ones(rows))
                         : VectorXd(Eigen::Map<const VectorXd>(deviations.data(), rows));
  const Series series(lengths, d);
  const FittedNoise noise(series, orthonormal_basis(jacobian));
  const double squares = residual.squaredNorm();
  result.freedom = deviations.empty()
                       ? std::max<double>(1, static_cast<double>(rows - jacobian.cols()))
                       : noise.freedom(0);
  result.scatter = std::sqrt(
      squares / std::max(1e-300, deviations.empty() ? result.freedom : noise.expected_squares(0)));
  result.meat_if_independent = numbers_of(jacobian.transpose() * series.correlated(jacobian, 0));
  result.meat = result.meat_if_independent;
  const double own = residual.dot(series.within(residual).col(0));
  const double deviation = noise.deviation_if_independent();
  if (!(own > 0) || !(deviation > 0)) return result;
  result.lag_one = residual.dot(series.neighbours(residual, 1).col(0)) / own;
  result.durbin_watson = squared_steps(residual.cwiseQuotient(d), lengths) / own;
  const double one_in_twenty = measured::normal_quantile(0.9);  // one side of a standard normal
  result.significant = result.lag_one - noise.expected(0, 1) > one_in_twenty * deviation;
  const Index lag = decorrelated_lag(series, residual);
  const double seen = residual.dot(series.neighbours(residual, lag).col(0)) / own;
  const auto rho = noise_correlation(noise, seen, lag);
  result.beyond_noise = !rho;
  result.autocorrelation =
      rho.value_or(std::pow(std::clamp(seen, 0.0, kMostCorrelated), 1 / static_cast<double>(lag)));
  if (!result.significant) return result;
  if (rho) result.scatter = std::sqrt(squares / noise.expected_squares(*rho));
  result.freedom = noise.freedom(result.autocorrelation);
  result.meat =
      numbers_of(jacobian.transpose() * series.correlated(jacobian, result.autocorrelation));
  return result;
}

}  // namespace palpate::calibrate
