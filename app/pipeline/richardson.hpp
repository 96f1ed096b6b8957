// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <vector>

namespace palpate::app {

/// Limit of values on finer and finer meshes, if the last three follow f(h) = f0 + c h^p
/// [Richardson 1911; for any ratio of sizes, Roache 1998, sec. 5.10], with an order p that
/// quadratic elements and a contact can have: 0.8 to 4. Others are chance, and extrapolate into
/// nowhere.
struct Extrapolation {
  double order;  ///< p; NaN where there is none
  double value;  ///< f0; the last value where there is no order
  double error;  ///< estimate of the error of the first value, relative to `value`
  /// Bound of that error: the distance of the first value from the last, and 1.25 times that of the
  /// last from the limit of an order of one [Roache 1998, sec. 5.6], since an order above is often
  /// chance. Without an order three times the spread of the last three values stands for the latter
  /// [Eca & Hoekstra 2014].
  double bound;
  bool trusted;  ///< whether there is an order
};

/// `sizes` descend; as many as values, at least three. A value that is NaN gives NaN throughout.
Extrapolation extrapolate(const std::vector<double>& sizes, const std::vector<double>& values);

}  // namespace palpate::app
