// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/body_size.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "format/error.hpp"

namespace palpate::mesher {
namespace {

// m
constexpr double kSmallestBody = 10e-6;
constexpr double kLargestBody = 10;
constexpr double kSmallestUsualBody = 1e-3;
constexpr double kLargestUsualBody = 2;

/// The unit with which the largest dimension is nearest to 150 mm, the size of an organ.
std::string likely_unit(double raw) {
  const std::pair<const char*, double> units[] = {
      {"m", 1}, {"cm", 0.01}, {"mm", 0.001}, {"um", 1e-6}};
  const auto deviation = [&](const auto& unit) {
    return std::abs(std::log10(raw * unit.second / 0.15));
  };
  return std::min_element(std::begin(units), std::end(units),
                          [&](const auto& a, const auto& b) { return deviation(a) < deviation(b); })
      ->first;
}

}  // namespace

void check_body_size(double raw, double unit, const std::string& where, const Log& log) {
  const double size = raw * unit;
  if (!(size >= kSmallestBody && size <= kLargestBody)) {
    refuse_geometry(where,
                    text("the largest dimension is ", millimetres(size), " with a unit of ", unit,
                         " m, outside 0.01 mm .. 10 m"),
                    raw > 0 && std::isfinite(raw)
                        ? "set the unit of the file; '" + likely_unit(raw) + "' looks likely"
                        : "the body has no extent: export it again");
  }
  if (size < kSmallestUsualBody || size > kLargestUsualBody) {
    warn(log,
         text(where, ": the largest dimension is ", millimetres(size), " with a unit of ", unit,
              " m, unusual for a body; '", likely_unit(raw), "' would be that of an organ"));
  }
}

}  // namespace palpate::mesher
