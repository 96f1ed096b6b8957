// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <deque>

namespace palpate::fem {

/// Anderson's acceleration of the fixed-point iteration X <- X + g(X) [Walker & Ni 2011]: the step
/// is that of the secant model of g through the last iterates, least squares. The first step is g.
class Anderson {
 public:
  /// The step from X, where g has the value `g`. All calls have matrices of one size.
  Eigen::Matrix3Xd step(const Eigen::Matrix3Xd& X, const Eigen::Matrix3Xd& g);

 private:
  Eigen::VectorXd last_X_, last_g_;
  std::deque<Eigen::VectorXd> dX_, dg_;
};

}  // namespace palpate::fem
