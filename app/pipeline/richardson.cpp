// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/richardson.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::app {
namespace {

constexpr double kLowest = 0.8, kHighest = 4;
constexpr double kSafety = 1.25, kSafetyWithoutOrder = 3;

/// (f1 - f2)/(f2 - f3) of values that follow h^p: it grows with p.
double ratio(double h1, double h2, double h3, double p) {
  return (std::pow(h1 / h3, p) - std::pow(h2 / h3, p)) / (std::pow(h2 / h3, p) - 1);
}

double order_of(double h1, double h2, double h3, double wanted) {
  if (!(wanted >= ratio(h1, h2, h3, kLowest) && wanted <= ratio(h1, h2, h3, kHighest)))
    return std::numeric_limits<double>::quiet_NaN();
  double low = kLowest, high = kHighest;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (ratio(h1, h2, h3, middle) < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// A difference over a value; 0 where there is none, as of forces of zero.
double part_of(double difference, double value) {
  return difference == 0 ? 0 : difference / std::abs(value);
}

}  // namespace

Extrapolation extrapolate(const std::vector<double>& sizes, const std::vector<double>& values) {
  const std::size_t n = values.size();
  const double h1 = sizes[n - 3], h2 = sizes[n - 2], h3 = sizes[n - 1];
  const double f1 = values[n - 3], f2 = values[n - 2], f3 = values[n - 1];
  const bool known =
      std::all_of(values.begin(), values.end(), [](double f) { return !std::isnan(f); });
  Extrapolation e{order_of(h1, h2, h3, (f1 - f2) / (f2 - f3)), f3, 0, 0, false};
  e.trusted = known && std::isfinite(e.order);
  double uncertainty = 0;
  if (e.trusted) {
    e.value = f3 + (f3 - f2) / (std::pow(h2 / h3, e.order) - 1);
    uncertainty = kSafety * std::abs(f3 - f2) / (std::pow(h2 / h3, std::min(e.order, 1.0)) - 1);
  } else {
    e.order = std::numeric_limits<double>::quiet_NaN();
    e.value = known ? f3 : e.order;
    uncertainty = kSafetyWithoutOrder * (std::max({f1, f2, f3}) - std::min({f1, f2, f3}));
  }
  e.error = part_of(values.front() - e.value, e.value);
  e.bound = known ? part_of(std::abs(values.front() - f3) + uncertainty, e.value)
                  : std::numeric_limits<double>::quiet_NaN();
  return e;
}

}  // namespace palpate::app
