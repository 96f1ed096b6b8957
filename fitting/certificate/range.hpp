// SPDX-License-Identifier: AGPL-3.0-or-later
// Interval arithmetic: what an expression can be while its arguments run through ranges.
#pragma once

#include <algorithm>
#include <cmath>

namespace palpate::fitting {

/// All numbers from low to high. A result holds every value of the expression; rounding is to
/// nearest, so its ends are true to the last digits only.
struct Range {
  double low = 0, high = 0;

  double middle() const { return 0.5 * (low + high); }
  double radius() const { return 0.5 * (high - low); }
  double magnitude() const { return std::max(std::abs(low), std::abs(high)); }

  friend Range operator+(const Range& a, const Range& b) {
    return {a.low + b.low, a.high + b.high};
  }
  friend Range operator-(const Range& a, const Range& b) {
    return {a.low - b.high, a.high - b.low};
  }
  friend Range operator*(double s, const Range& a) {
    return s >= 0 ? Range{s * a.low, s * a.high} : Range{s * a.high, s * a.low};
  }
  friend Range operator*(const Range& a, const Range& b) {
    const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
    return {std::min({p, q, r, s}), std::max({p, q, r, s})};
  }
  /// @pre b.low > 0
  friend Range operator/(const Range& a, const Range& b) {
    return {a.low / (a.low < 0 ? b.low : b.high), a.high / (a.high < 0 ? b.high : b.low)};
  }
};

inline Range square(const Range& a) {
  const double least = a.low > 0 ? a.low : a.high < 0 ? a.high : 0.0;
  return {least * least, a.magnitude() * a.magnitude()};
}

/// @pre a.low >= 0
inline Range root(const Range& a) {
  return {std::sqrt(a.low), std::sqrt(a.high)};
}

/// What is in both. @pre there is something
inline Range common(const Range& a, const Range& b) {
  return {std::max(a.low, b.low), std::min(a.high, b.high)};
}

inline Range hull(const Range& a, const Range& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

}  // namespace palpate::fitting
