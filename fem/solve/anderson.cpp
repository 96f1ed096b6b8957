// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/anderson.hpp"

#include <Eigen/QR>

namespace palpate::fem {

namespace {
constexpr std::size_t kPairs = 10;
}

Eigen::Matrix3Xd Anderson::step(const Eigen::Matrix3Xd& X, const Eigen::Matrix3Xd& g) {
  const Eigen::VectorXd x = X.reshaped(), value = g.reshaped();
  if (last_X_.size() > 0) {
    dX_.push_back(x - last_X_);
    dg_.push_back(value - last_g_);
    if (dX_.size() > kPairs) {
      dX_.pop_front();
      dg_.pop_front();
    }
  }
  last_X_ = x;
  last_g_ = value;
  Eigen::VectorXd d = value;
  if (!dg_.empty()) {
    Eigen::MatrixXd G(value.size(), static_cast<Eigen::Index>(dg_.size()));
    for (std::size_t i = 0; i < dg_.size(); ++i) G.col(static_cast<Eigen::Index>(i)) = dg_[i];
    const Eigen::VectorXd gamma = G.colPivHouseholderQr().solve(value);
    for (std::size_t i = 0; i < dg_.size(); ++i)
      d -= gamma[static_cast<Eigen::Index>(i)] * (dX_[i] + dg_[i]);
  }
  return Eigen::Map<const Eigen::Matrix3Xd>(d.data(), 3, g.cols());
}

}  // namespace palpate::fem
