// SPDX-License-Identifier: AGPL-3.0-or-later
// How much a model explains for the number of its constants, where the noise is correlated.
#pragma once

#include <cstddef>
#include <vector>

namespace palpate::calibrate {

struct Information {
  double autocorrelation = 0;  ///< r of neighbouring samples that makes the likelihood largest
  double aicc = 0;             ///< -2 ln L + 2 k + 2 k (k + 1)/(n - k - 1) [Hurvich & Tsai 1989]
  double bic = 0;              ///< -2 ln L + k ln n [Schwarz 1978]
};

/// Residuals of a fit of `constants`; k counts also the variance and r. The likelihood is that
/// of normal noise with the covariance s^2 r^|i-j| within a series, 0 <= r <= 0.999, s and r those
/// that make it largest:
///   -2 ln L = n ln(Q/n) - (number of series) ln(1 - r^2),
///   Q = sum over the series of (1 - r^2) e_1^2 + sum of (e_i - r e_i-1)^2,
/// up to a constant. @param series  lengths; their sum is the number of residuals.
Information information_of(const std::vector<double>& residuals,
                           const std::vector<std::size_t>& series, std::size_t constants);

}  // namespace palpate::calibrate
