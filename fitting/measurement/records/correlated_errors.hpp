// SPDX-License-Identifier: AGPL-3.0-or-later
// What the residuals of a least squares fit to a record say about its errors.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace palpate::measured {

struct ErrorEstimate {
  double deviation = 0;        ///< of the noise of one sample
  double autocorrelation = 0;  ///< r of neighbouring samples; 0 where chance explains it
  Eigen::MatrixXd covariance;  ///< of the unknowns
};

/// Covariance of the unknowns x of an ordinary least squares fit whose noise has V_ij = s^2
/// r^|i-j| within a stretch of consecutive samples and none between stretches:
///   S = s^2 (J^T J)^-1 J^T V J (J^T J)^-1,  s^2 = |e|^2/(n - tr((J^T J)^-1 J^T V J)).
/// r is the one for which residuals with as many smooth columns taken out are expected to have the
/// lag-one correlation that is seen; 0 unless it exceeds chance one time in twenty.
/// @param J  one row a sample, full column rank; @param residual  of the best fit.
/// @param stretches  lengths, their sum is the number of rows.
ErrorEstimate estimate_errors(const Eigen::MatrixXd& J, const Eigen::VectorXd& residual,
                              const std::vector<std::size_t>& stretches);

}  // namespace palpate::measured
