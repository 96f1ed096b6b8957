// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <vector>

namespace palpate::app {

/// Limit of values on finer and finer meshes, if the last three follow f(h) = f0 + c h^p
/// [Richardson 1911; for any ratio of sizes, Roache 1998, sec. 5.10].
struct Extrapolation {
  double order;  ///< p; NaN where the last three values do not follow such a law, 0.3 <= p <= 6
  double value;  ///< f0; the last value where there is no order
  double error;  ///< estimated relative error of the first value
  bool trusted;  ///< false: no order; the error is the spread of the values over the last one
};

/// `sizes` descend; as many as values, at least three. A value that is NaN gives NaN throughout.
Extrapolation extrapolate(const std::vector<double>& sizes, const std::vector<double>& values);

}  // namespace palpate::app
