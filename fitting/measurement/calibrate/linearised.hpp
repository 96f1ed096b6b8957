// SPDX-License-Identifier: AGPL-3.0-or-later
// A least squares problem made linear at a point, and its steps within bounds.
#pragma once

#include <Eigen/Dense>

namespace palpate::calibrate {

/// r + J p, with steps p that are measured by what they do to the residuals: each constant by the
/// length of its column of J, so that units do not matter [Marquardt 1963].
class Linearised {
 public:
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using Vector = Eigen::VectorXd;

  Linearised(const RowMajor& J, const Vector& r);

  /// The p within low <= p <= high that makes |r + J p|^2 + damping |p|^2 least, by an active set
  /// [Stark & Parker 1995]: where a bound holds a constant, the others go to their best beside it.
  /// Clipping a step at a bound would tear constants apart that are correlated.
  /// @param low, high  not above and not below 0; may be infinite.
  Vector step(double damping, const Vector& low, const Vector& high) const;
  /// By how much p lowers |r + J p|^2/2.
  double decrease(const Vector& p) const;
  double length(const Vector& p) const { return scale_.cwiseProduct(p).norm(); }

 private:
  Vector scale_;       ///< lengths of the columns; 1 for a column of zeros
  Eigen::MatrixXd R_;  ///< of J over scale = Q R
  Vector c_;           ///< Q^T r
};

}  // namespace palpate::calibrate
