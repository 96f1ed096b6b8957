// SPDX-License-Identifier: AGPL-3.0-or-later
// Statistics of measured curves.
#pragma once

#include <array>
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

/// Variance inflation of an estimate whose residuals are correlated from sample to sample:
/// (1 + r)/(1 - r) with r the correlation at lag one, at least 1 [Bayley & Hammersley 1946].
double correlation_factor(const std::vector<double>& residual);

/// The x in [low, high] of least value: a scan of `cells` cells, then golden section in the best.
double minimise_scan(const std::function<double(double)>& value, double low, double high,
                     int cells);

/// Normal equations of a least squares problem with three unknowns.
class Symmetric3 {
 public:
  void add(const std::array<double, 3>& row, double right);
  bool solve(std::array<double, 3>& x) const;  ///< false when singular

 private:
  std::array<std::array<double, 4>, 3> m_{};
};

/// Information matrix of four unknowns.
class Symmetric4 {
 public:
  void add(const std::array<double, 4>& row);
  double inverse_first() const;  ///< first diagonal entry of the inverse; infinite when singular

 private:
  std::array<std::array<double, 4>, 4> m_{};
};

/// The t for which a variable of Student's distribution lies in [-t, t] with this probability.
double student_quantile(double probability, double freedom);
/// The same of a standard normal variable.
double normal_quantile(double probability);

}  // namespace palpate::measured
