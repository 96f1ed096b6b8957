// SPDX-License-Identifier: AGPL-3.0-or-later
// Noise whose neighbouring samples are alike.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace palpate::fitting {

/// V X for V_ij = r^|i-j| within each stretch of consecutive rows and 0 between stretches, in a
/// time proportional to the number of entries of X. @param stretches  lengths, their sum is the
/// number of rows.
template <class Length>
Eigen::MatrixXd autoregressive_product(const Eigen::MatrixXd& X, double r,
                                       const std::vector<Length>& stretches) {
  Eigen::MatrixXd out = X;
  Eigen::Index first = 0;
  for (const Length length : stretches) {
    const auto m = static_cast<Eigen::Index>(length);
    Eigen::MatrixXd before = X.middleRows(first, m), after = before;
    for (Eigen::Index i = 1; i < m; ++i) before.row(i) += r * before.row(i - 1);
    for (Eigen::Index i = m - 1; i > 0; --i) after.row(i - 1) += r * after.row(i);
    out.middleRows(first, m) = before + after - X.middleRows(first, m);
    first += m;
  }
  return out;
}

}  // namespace palpate::fitting
