// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

namespace palpate::measured {

double mean(const std::vector<double>& values) {
  if (values.empty()) return 0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double deviation(const std::vector<double>& values) {
  if (values.size() < 2) return 0;
  const double centre = mean(values);
  double squares = 0;
  for (const double value : values) squares += (value - centre) * (value - centre);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

LineFit fit_line(const std::vector<double>& x, const std::vector<double>& y) {
  const double x0 = mean(x), y0 = mean(y);
  double xx = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - x0) * (x[i] - x0);
    xy += (x[i] - x0) * (y[i] - y0);
  }
  LineFit fit;
  fit.slope = xx > 0 ? xy / xx : 0;
  fit.offset = y0 - fit.slope * x0;
  double squares = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double r = y[i] - fit.offset - fit.slope * x[i];
    squares += r * r;
  }
  if (x.size() > 2) fit.residual = std::sqrt(squares / static_cast<double>(x.size() - 2));
  if (xx > 0) fit.slope_uncertainty = fit.residual / std::sqrt(xx);
  return fit;
}

double minimise_scan(const std::function<double(double)>& value, double low, double high,
                     int cells) {
  const double width = (high - low) / cells;
  double best = low, least = value(low);
  for (int i = 1; i <= cells; ++i) {
    const double x = low + i * width, here = value(x);
    if (here < least) {
      least = here;
      best = x;
    }
  }
  const double golden = 0.5 * (std::sqrt(5.0) - 1);
  double a = std::max(low, best - width), b = std::min(high, best + width);
  double c = b - golden * (b - a), d = a + golden * (b - a);
  double at_c = value(c), at_d = value(d);
  for (int i = 0; i < 60; ++i) {
    if (at_c < at_d) {
      b = d;
      d = c;
      at_d = at_c;
      c = b - golden * (b - a);
      at_c = value(c);
    } else {
      a = c;
      c = d;
      at_c = at_d;
      d = a + golden * (b - a);
      at_d = value(d);
    }
  }
  const double found = 0.5 * (a + b);
  return value(found) <= least ? found : best;
}

double student_quantile(double probability, double freedom) {
  return quantile(boost::math::students_t(freedom), 0.5 * (1 + probability));
}

double normal_quantile(double probability) {
  return quantile(boost::math::normal(), 0.5 * (1 + probability));
}

}  // namespace palpate::measured
