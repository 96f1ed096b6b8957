// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/body_size.hpp"

#include <cmath>

#include "format/error.hpp"
#include "mesher/read/unit_guess.hpp"

namespace palpate::mesher {
namespace {

// m
constexpr double kSmallestBody = 10e-6;
constexpr double kLargestBody = 10;
constexpr double kSmallestUsualBody = 1e-3;
constexpr double kLargestUsualBody = 2;

std::string likely_unit(double raw) {
  return std::string(guess_unit(raw).likely.symbol);
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
