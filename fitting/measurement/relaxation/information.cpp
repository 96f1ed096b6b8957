// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/relaxation/information.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/measurement/records/statistics.hpp"
#include "format/numbers.hpp"

namespace palpate::calibrate {
namespace {

/// -2 ln L with the variance that makes L largest.
double deviance(const std::vector<double>& e, const std::vector<std::size_t>& series, double r) {
  double squares = 0;
  std::size_t first = 0;
  for (const std::size_t length : series) {
    if (length > 0) squares += (1 - r * r) * e[first] * e[first];
    for (std::size_t i = first + 1; i < first + length; ++i)
      squares += (e[i] - r * e[i - 1]) * (e[i] - r * e[i - 1]);
    first += length;
  }
  const auto n = static_cast<double>(e.size());
  return n * std::log(std::max(squares, 1e-300) / n) -
         static_cast<double>(series.size()) * std::log(1 - r * r);
}

}  // namespace

Information information_of(const std::vector<double>& residuals,
                           const std::vector<std::size_t>& series, std::size_t constants) {
  constexpr double kMost = 0.999;
  constexpr int kCells = 50;
  Information found;
  const auto at = [&](double r) { return deviance(residuals, series, r); };
  found.autocorrelation = measured::minimise_scan(at, 0, kMost, kCells);
  const double least = at(found.autocorrelation);
  const auto n = static_cast<double>(residuals.size()), k = static_cast<double>(constants + 2);
  found.aicc = n > k + 1 ? least + 2 * k + 2 * k * (k + 1) / (n - k - 1) : kInfinity;
  found.bic = least + k * std::log(n);
  return found;
}

}  // namespace palpate::calibrate
