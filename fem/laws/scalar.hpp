// SPDX-License-Identifier: AGPL-3.0-or-later
// Functions that the laws call on their scalar: double for a single point, Lanes for eight elements
// at once, ceres::Jet for derivatives. The templates find the functions of a scalar by
// argument-dependent lookup.
#pragma once

#include <cmath>
#include <type_traits>

#include "fem/laws/lanes.hpp"

namespace palpate::fem {

/// J^{-2/3}, by which the isochoric C is a multiple of C.
template <class T>
T isochoric_scale(const T& J) {
  using std::pow;
  return pow(J, -2.0 / 3.0);
}
/// Volume ratios are near 1: a polynomial is within 4e-4 of J^{-1/3}, and with e = 1 - J y^3 the
/// series y (1 + e/3 + 2 e^2/9 + ...) within 1e-15, in a fraction of the time of a logarithm.
inline Lanes isochoric_scale(const Lanes& J) {
  if (!(J >= 0.5 && J <= 2).all()) return ((-2.0 / 3.0) * J.log()).exp();
  const Lanes t = J - 1.25;
  const Lanes y =
      0.9285975441 +
      t * (-0.2484808853 +
           t * (0.1236762303 + t * (-0.07088425975 + t * (0.08948418231 - 0.07066833362 * t))));
  const Lanes e = 1 - J * y * y * y;
  const Lanes root = y + y * e * (1.0 / 3 + e * (2.0 / 9 + e * (14.0 / 81 + (35.0 / 243) * e)));
  return root * root;
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
