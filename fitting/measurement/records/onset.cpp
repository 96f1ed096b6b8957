// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/onset.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fitting/measurement/records/correlated_errors.hpp"
#include "fitting/measurement/records/statistics.hpp"

namespace palpate::measured {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

using Eigen::Matrix4d;
using Eigen::Vector4d;

/// The unknowns in which the model is linear: a, b, a1, a2.
constexpr Index kRise = 2, kBend = 3;

double power(double z, double p) {
  if (p == 1) return z;
  if (p == 1.5) return z * std::sqrt(z);
  if (p == 2) return z * z;
  return std::pow(z, p);
}

/// The model at one contact point: linear in its other constants. Depths and times are scaled, so
/// that the normal equations are well conditioned.
class Profile {
 public:
  Profile(const OnsetSamples& samples, const OnsetModel& model)
      : s_(samples),
        p_(model.exponent),
        offset_(model.offset),
        drift_(model.offset && model.drift) {
    for (std::size_t i = 0; i < s_.size(); ++i) {
      if (s_.free[i] != 0) continue;
      low_ = std::min(low_, s_.displacement[i]);
      high_ = std::max(high_, s_.displacement[i]);
    }
    if (drift_) {
      const auto [first, last] = std::minmax_element(s_.time.begin(), s_.time.end());
      duration_ = std::max(*last - *first, std::numeric_limits<double>::min());
    }
  }

  double low() const { return low_; }
  double high() const { return high_; }
  double depth_scale(double c) const { return std::max(high_ - c, 1e-9 * (high_ - low_)); }
  double duration() const { return duration_; }
  bool has(Index column) const { return column >= kRise || (column == 0 ? offset_ : drift_); }

  double depth(std::size_t i, double c, double scale) const {
    return s_.free[i] != 0 ? 0 : std::max(0.0, (s_.displacement[i] - c) / scale);
  }

  /// Coefficients of sample i; 0 where the model has no such unknown.
  Vector4d row(std::size_t i, double c, double scale) const {
    const double z = depth(i, c, scale), rise = power(z, p_);
    return {offset_ ? 1.0 : 0.0, drift_ ? s_.time[i] / duration_ : 0.0, rise, z * rise};
  }

  /// Sum of squares at contact point c, and the constants; infinite where a1 < 0.
  double squares(double c, Vector4d& constants) const {
    const double scale = depth_scale(c);
    Matrix4d normal = Matrix4d::Zero();
    Vector4d right = Vector4d::Zero();
    double forces = 0;
    const double centre = offset_ ? s_.force.front() : 0;
    for (std::size_t i = 0; i < s_.size(); ++i) {
      const Vector4d r = row(i, c, scale);
      const double f = s_.force[i] - centre;
      normal += r * r.transpose();
      right += f * r;
      forces += f * f;
    }
    for (Index k = 0; k < 4; ++k) {
      if (!has(k)) normal(k, k) = 1;
    }
    const Eigen::LDLT<Matrix4d> factor(normal);
    if (!(factor.vectorD().minCoeff() > 1e-13 * factor.vectorD().maxCoeff())) return kNone;
    constants = factor.solve(right);
    if (constants[kRise] < 0) return kNone;
    const double rest = forces - right.dot(constants);
    if (offset_) constants[0] += centre;
    return rest;
  }

  static constexpr double kNone = std::numeric_limits<double>::infinity();

 private:
  const OnsetSamples& s_;
  double p_;
  bool offset_, drift_;
  double low_ = kNone, high_ = -kNone, duration_ = 1;
};

/// Covariance of offset, drift and contact from that of all unknowns; `meaning` has 0, 1, 2 for
/// those three, others for the rest.
void take_covariance(const MatrixXd& all, const std::vector<std::size_t>& meaning,
                     OnsetEstimate& estimate) {
  for (Index i = 0; i < all.rows(); ++i)
    for (Index j = 0; j < all.cols(); ++j) {
      const std::size_t a = meaning[static_cast<std::size_t>(i)];
      const std::size_t b = meaning[static_cast<std::size_t>(j)];
      if (a < 3 && b < 3) estimate.covariance[a][b] = all(i, j);
    }
}

}  // namespace

OnsetEstimate fit_onset(const OnsetSamples& samples, const OnsetModel& model) {
  constexpr int kCells = 120;
  const Profile profile(samples, model);
  const bool drift = model.offset && model.drift;
  const double range = profile.high() - profile.low();
  // With a drift, an onset long before the samples fits as well as a line.
  const double begin = profile.low() - (drift ? 0.02 : 0.25) * range,
               end = profile.high() - range / 8;
  Vector4d constants = Vector4d::Zero();
  const auto squares = [&](double c) { return profile.squares(c, constants); };
  OnsetEstimate estimate;
  const double c = estimate.contact = minimise_scan(squares, begin, end, kCells);
  profile.squares(c, constants);

  // The linearised model, with the contact point as the last unknown.
  const double scale = profile.depth_scale(c), p = model.exponent;
  std::vector<Index> columns;
  std::vector<std::size_t> meaning;
  std::vector<double> units;
  for (const Index k : {Index{0}, Index{1}, kRise, kBend}) {
    if (!profile.has(k)) continue;
    columns.push_back(k);
    meaning.push_back(k < kRise ? static_cast<std::size_t>(k) : 3);
    units.push_back(k == 1 ? 1 / profile.duration() : 1);
  }
  meaning.push_back(2);
  units.push_back(scale);
  const auto last = static_cast<Index>(columns.size());
  MatrixXd J(static_cast<Index>(samples.size()), last + 1);
  VectorXd residual(J.rows());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto at = static_cast<Index>(i);
    const Vector4d row = profile.row(i, c, scale);
    const double z = profile.depth(i, c, scale);
    J.row(at).head(last) = row(columns).transpose();
    J(at, last) = z > 0 ? -(p * constants[kRise] / z + (p + 1) * constants[kBend]) * row[kRise] : 0;
    residual[at] = samples.force[i] - row.dot(constants);
  }
  const ErrorEstimate errors = estimate_errors(J, residual, samples.stretches);
  estimate.offset = constants[0];
  estimate.drift = constants[1] / profile.duration();
  estimate.noise = errors.deviation;
  estimate.autocorrelation = errors.autocorrelation;
  const Eigen::Map<const VectorXd> unit(units.data(), last + 1);
  take_covariance(unit.asDiagonal() * errors.covariance * unit.asDiagonal(), meaning, estimate);
  return estimate;
}

namespace {

/// Least squares polynomial in the time over its span.
struct Polynomial {
  VectorXd constants;
  ErrorEstimate errors;
  double duration = 1;
};

Polynomial fit_polynomial(const OnsetSamples& samples, Index degree) {
  Polynomial fit;
  const auto rows = static_cast<Index>(samples.size());
  const Eigen::Map<const VectorXd> force(samples.force.data(), rows);
  MatrixXd J = MatrixXd::Ones(rows, degree + 1);
  if (degree > 0) {
    const Eigen::Map<const VectorXd> time(samples.time.data(), rows);
    fit.duration = std::max(time.maxCoeff() - time.minCoeff(), std::numeric_limits<double>::min());
    for (Index k = 1; k <= degree; ++k) {
      J.col(k) = (J.col(k - 1).array() * time.array() / fit.duration).matrix();
    }
  }
  fit.constants = J.colPivHouseholderQr().solve(force);
  fit.errors = estimate_errors(J, force - J * fit.constants, samples.stretches);
  return fit;
}

}  // namespace

OnsetEstimate fit_baseline(const OnsetSamples& samples, bool drift) {
  const Polynomial fit = fit_polynomial(samples, drift ? 1 : 0);
  OnsetEstimate estimate;
  estimate.offset = fit.constants[0];
  if (drift) estimate.drift = fit.constants[1] / fit.duration;
  VectorXd units = VectorXd::Ones(fit.constants.size());
  if (drift) units[1] = 1 / fit.duration;
  estimate.noise = fit.errors.deviation;
  estimate.autocorrelation = fit.errors.autocorrelation;
  take_covariance(units.asDiagonal() * fit.errors.covariance * units.asDiagonal(), {0, 1},
                  estimate);
  return estimate;
}

bool is_straight(const OnsetSamples& samples) {
  constexpr std::size_t kFewest = 6;
  if (samples.size() < kFewest) return false;
  const Polynomial fit = fit_polynomial(samples, 2);
  const double freedom = static_cast<double>(samples.size()) - 3;
  const double u = std::sqrt(std::max(0.0, fit.errors.covariance(2, 2)));
  return std::abs(fit.constants[2]) <= student_quantile(0.99, freedom) * u;
}

}  // namespace palpate::measured
