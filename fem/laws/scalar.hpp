// SPDX-License-Identifier: AGPL-3.0-or-later
// Functions that the laws call on their scalar, for a single point (double) and for eight elements
// at once (Lanes). Another scalar brings its own, found by argument-dependent lookup.
#pragma once

#include <cmath>

#include "fem/laws/lanes.hpp"

namespace palpate::fem {

inline double power_of(double x, double exponent) {
  return std::pow(x, exponent);
}
/// By exp and log, which are vector code as pow is not; exact to round-off for x near 1, as a
/// volume ratio is.
inline Lanes power_of(const Lanes& x, double exponent) {
  return (exponent * x.log()).exp();
}

inline double logarithm(double x) {
  return std::log(x);
}
inline Lanes logarithm(const Lanes& x) {
  return x.log();
}

inline double exponential(double x) {
  return std::exp(x);
}
inline Lanes exponential(const Lanes& x) {
  return x.exp();
}

inline double square_root(double x) {
  return std::sqrt(x);
}
inline Lanes square_root(const Lanes& x) {
  return x.sqrt();
}

/// 1 where x > bound, else 0: choices without branches.
inline double exceeds(double x, double bound) {
  return x > bound ? 1.0 : 0.0;
}
inline Lanes exceeds(const Lanes& x, double bound) {
  return (x > bound).cast<double>();
}

/// A number as a scalar.
template <class T>
T constant_of(double value) {
  return T(value);
}
template <>
inline Lanes constant_of<Lanes>(double value) {
  return Lanes::Constant(value);
}

}  // namespace palpate::fem
