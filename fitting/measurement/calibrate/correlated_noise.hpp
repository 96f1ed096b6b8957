// SPDX-License-Identifier: AGPL-3.0-or-later
// What residuals that follow each other say about one another: where a law misses the shape of a
// curve, neighbouring residuals are alike, and they count for less than as many independent ones.
#pragma once

#include <cstddef>
#include <vector>

namespace palpate::calibrate {

/// Residuals of a least squares fit, as noise with V_ij = r^|i-j| within a series, none between.
struct CorrelatedNoise {
  double lag_one = 0;          ///< sum r_i r_i+1 / sum r_i^2 over the series, as they are
  double durbin_watson = 2;    ///< sum (r_i+1 - r_i)^2 / sum r_i^2; 2 for independent noise
  double autocorrelation = 0;  ///< r of the noise: lag_one without what the fit took out of it
  bool significant = false;    ///< lag_one is more than chance gives independent noise
  double scatter = 0;          ///< standard deviation of the noise
  double freedom = 0;          ///< of that scatter [Satterthwaite 1946]
  /// J^T V J, row by row, of the columns that were given; empty when not significant.
  std::vector<double> meat;
};

/// Moment estimate: the r for which the expected lag-one correlation of the residuals of a fit with
/// this Jacobian, M V M with M = I - J (J^T J)^-1 J^T, is the one that is seen; at most 0.98.
/// Significant when it exceeds its expectation for independent noise by 1.645 of its standard
/// deviations there (one in twenty by chance) [Durbin & Watson 1950, who tabulate the same].
/// @param J  row by row, `columns` of them.
/// @param r  residuals at the best fit.
/// @param series  lengths of the series, one after the other from the first residual on; what is
///   left are residuals on their own.
CorrelatedNoise correlated_noise(const std::vector<double>& J, std::size_t columns,
                                 const std::vector<double>& r,
                                 const std::vector<std::size_t>& series);

}  // namespace palpate::calibrate
