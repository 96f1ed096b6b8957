// SPDX-License-Identifier: AGPL-3.0-or-later
// A measured value with its uncertainty.
#pragma once

#include "format/numbers.hpp"

namespace palpate::identify {

/// A value with its standard deviation; NaN where it was not determined.
struct Measured {
  double value = kUnknown;
  double deviation = kUnknown;

  /// Bounds on the safe side, two and a half standard deviations away: 99 % of a normal
  /// distribution, and some 97 % where the deviation itself is an estimate from twenty blocks.
  static constexpr double kSafe = 2.5;
  double low() const { return value - kSafe * deviation; }
  double high() const { return value + kSafe * deviation; }
};

}  // namespace palpate::identify
