// SPDX-License-Identifier: AGPL-3.0-or-later
// Functions that the laws call on their scalar: double for a single point, Lanes for eight elements
// at once, ceres::Jet for derivatives. The templates find the functions of a scalar by
// argument-dependent lookup.
#pragma once

#include <cmath>
#include <type_traits>

#include "fem/laws/lanes.hpp"

namespace palpate::fem {

template <class T>
T power_of(const T& x, double exponent) {
  using std::pow;
  return pow(x, exponent);
}
/// By exp and log, which are vector code as pow is not; exact to round-off for x near 1, as a
/// volume ratio is.
inline Lanes power_of(const Lanes& x, double exponent) {
  return (exponent * x.log()).exp();
}

template <class T>
T logarithm(const T& x) {
  using std::log;
  return log(x);
}
inline Lanes logarithm(const Lanes& x) {
  return x.log();
}

template <class T>
T exponential(const T& x) {
  using std::exp;
  return exp(x);
}
inline Lanes exponential(const Lanes& x) {
  return x.exp();
}

template <class T>
T square_root(const T& x) {
  using std::sqrt;
  return sqrt(x);
}
inline Lanes square_root(const Lanes& x) {
  return x.sqrt();
}

/// 1 where x > bound, else 0: choices without branches.
template <class T>
T exceeds(const T& x, double bound) {
  return T(x > bound ? 1.0 : 0.0);
}
inline Lanes exceeds(const Lanes& x, double bound) {
  return (x > bound).cast<double>();
}

/// A constant of a law as a scalar T.
template <class T, class Constant>
T constant_of(const Constant& value) {
  if constexpr (std::is_same_v<T, Lanes>)
    return Lanes::Constant(value);
  else
    return T(value);
}

}  // namespace palpate::fem
