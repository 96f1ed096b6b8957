// SPDX-License-Identifier: AGPL-3.0-or-later
// Statistics of measured curves.
#pragma once

#include <functional>
#include <vector>

namespace palpate::measured {

double mean(const std::vector<double>& values);  ///< 0 for none
double median(std::vector<double> values);       ///< 0 for none
/// Sample standard deviation, n - 1; 0 for fewer than two.
double deviation(const std::vector<double>& values);

/// Least squares line y = offset + slope x.
struct LineFit {
  double offset = 0, slope = 0;
  double slope_uncertainty = 0;  ///< standard, for independent errors
  double residual = 0;           ///< standard deviation of the residuals, n - 2
};
LineFit fit_line(const std::vector<double>& x, const std::vector<double>& y);

/// The x in [low, high] of least value: a scan of `cells` cells, then golden section in the best.
double minimise_scan(const std::function<double(double)>& value, double low, double high,
                     int cells);

/// The t for which a variable of Student's distribution lies in [-t, t] with this probability.
double student_quantile(double probability, double freedom);
/// The same of a standard normal variable.
double normal_quantile(double probability);

}  // namespace palpate::measured
