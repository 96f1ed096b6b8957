// SPDX-License-Identifier: AGPL-3.0-or-later
// Interval arithmetic with outward rounding.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::fitting {

/// Factor by which bounds are raised for scalar arithmetic that is not in intervals: fewer than a
/// thousand operations, each with a relative error of 1.1e-16.
inline constexpr double kRoundingFactor = 1 + 1e-12;

/// A number below (above) every real number that rounds to `v`. Zero stays zero, because a sum,
/// product or quotient of doubles is exact when it is zero, apart from underflow. Infinity stays
/// infinity.
inline double round_down(double v) {
  return v * (1 - std::copysign(std::numeric_limits<double>::epsilon(), v));
}
inline double round_up(double v) {
  return v * (1 + std::copysign(std::numeric_limits<double>::epsilon(), v));
}

/// All numbers from low to high. The result of an operation contains every value of the exact
/// operation: both ends are rounded outward. @pre no underflow
struct Range {
  double low = 0, high = 0;

  [[gnu::always_inline]] static Range outward(double low, double high) {
    return {round_down(low), round_up(high)};
  }

  double middle() const { return 0.5 * (low + high); }
  double radius() const { return 0.5 * (high - low); }
  double magnitude() const { return std::max(std::abs(low), std::abs(high)); }

  [[gnu::always_inline]] friend Range operator+(const Range& a, const Range& b) {
    return outward(a.low + b.low, a.high + b.high);
  }
  [[gnu::always_inline]] friend Range operator-(const Range& a, const Range& b) {
    return outward(a.low - b.high, a.high - b.low);
  }
  [[gnu::always_inline]] friend Range operator*(double s, const Range& a) {
    return s >= 0 ? outward(s * a.low, s * a.high) : outward(s * a.high, s * a.low);
  }
  [[gnu::always_inline]] friend Range operator*(const Range& a, const Range& b) {
    const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
    // not of a list, which GCC 12 writes to memory
    return outward(std::min(std::min(std::min(p, q), r), s),
                   std::max(std::max(std::max(p, q), r), s));
  }
  /// @pre b.low > 0
  [[gnu::always_inline]] friend Range operator/(const Range& a, const Range& b) {
    return outward(a.low / (a.low < 0 ? b.low : b.high), a.high / (a.high < 0 ? b.high : b.low));
  }
};

[[gnu::always_inline]] inline Range square(const Range& a) {
  const double least = a.low > 0 ? a.low : a.high < 0 ? a.high : 0.0;
  return Range::outward(least * least, a.magnitude() * a.magnitude());
}

/// @pre a.low >= 0
[[gnu::always_inline]] inline Range root(const Range& a) {
  return Range::outward(std::sqrt(a.low), std::sqrt(a.high));
}

/// Intersection. @pre it is not empty
[[gnu::always_inline]] inline Range common(const Range& a, const Range& b) {
  return {std::max(a.low, b.low), std::min(a.high, b.high)};
}

[[gnu::always_inline]] inline Range hull(const Range& a, const Range& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

}  // namespace palpate::fitting
