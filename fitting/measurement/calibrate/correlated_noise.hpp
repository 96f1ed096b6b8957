// SPDX-License-Identifier: AGPL-3.0-or-later
// What residuals that follow each other say about one another: where a law misses the shape of a
// curve, neighbouring residuals are alike, and they count for less than as many independent ones.
#pragma once

#include <cstddef>
#include <vector>

namespace palpate::calibrate {

/// Residuals of a least squares fit, as noise with the covariance d_i d_j r^|i-j| within a series,
/// none between.
struct CorrelatedNoise {
  double lag_one = 0;          ///< sum r_i r_i+1 / sum r_i^2 over the series, of residuals over d
  double durbin_watson = 2;    ///< sum (r_i+1 - r_i)^2 / sum r_i^2; 2 for independent noise
  double autocorrelation = 0;  ///< r of the noise: what the fit took out of it is put back
  bool significant = false;    ///< lag_one is more than chance gives independent noise
  /// The residuals stay more alike than those of any such noise would: r is their own, and the
  /// scatter is not raised for what a fit takes out of noise.
  bool beyond_noise = false;
  double scatter = 0;  ///< standard deviation of the noise where d is 1
  double freedom = 0;  ///< of that scatter [Satterthwaite 1946]
  /// J^T D V D J, row by row, of the columns that were given, with the correlation where it is
  /// significant; and the same for independent noise.
  std::vector<double> meat, meat_if_independent;
};

/// Moment estimate: the r for which the expected correlation of the residuals of a fit with this
/// Jacobian, M D V D M with M = I - J (J^T J)^-1 J^T, is the one that is seen, at the first lag at
/// which the residuals are less alike than one half: there, smooth residuals show how far they stay
/// alike. At most 0.98 at that lag. Significant when the correlation at lag one exceeds its
/// expectation for independent noise by 1.645 of its standard deviations there (one in twenty by
/// chance) [Durbin & Watson 1950, who tabulate the same].
/// @param J  row by row, `columns` of them.
/// @param r  residuals at the best fit.
/// @param series  lengths of the series, one after the other from the first residual on; what is
///   left are residuals on their own.
/// @param deviations  d, relative standard deviations of the noise of the residuals; empty: alike.
CorrelatedNoise correlated_noise(const std::vector<double>& J, std::size_t columns,
                                 const std::vector<double>& r,
                                 const std::vector<std::size_t>& series,
                                 const std::vector<double>& deviations = {});

}  // namespace palpate::calibrate
