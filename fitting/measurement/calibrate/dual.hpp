// SPDX-License-Identifier: AGPL-3.0-or-later
// Forward automatic differentiation: a value with its derivatives by N variables. The scalar may be
// a Dual itself, which gives second derivatives.
#pragma once

#include <array>
#include <cmath>

namespace palpate::calibrate {

template <class T, int N>
struct Dual {
  T value{};
  std::array<T, N> slope{};

  Dual() = default;
  Dual(double constant) : value(constant) {}  // NOLINT: numbers are constants
  Dual(const T& v, int variable) : value(v) { slope[static_cast<std::size_t>(variable)] = T(1.0); }

  /// The function with this value and derivative at `value`, by the chain rule.
  Dual chain(const T& f, const T& derivative) const {
    Dual out;
    out.value = f;
    for (std::size_t i = 0; i < N; ++i) out.slope[i] = derivative * slope[i];
    return out;
  }

  Dual operator-() const { return chain(-value, T(-1.0)); }
  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }

  friend Dual operator+(const Dual& a, const Dual& b) {
    Dual out;
    out.value = a.value + b.value;
    for (std::size_t i = 0; i < N; ++i) out.slope[i] = a.slope[i] + b.slope[i];
    return out;
  }
  friend Dual operator-(const Dual& a, const Dual& b) { return a + (-b); }
  friend Dual operator*(const Dual& a, const Dual& b) {
    Dual out;
    out.value = a.value * b.value;
    for (std::size_t i = 0; i < N; ++i) out.slope[i] = a.slope[i] * b.value + a.value * b.slope[i];
    return out;
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const T inverse = T(1.0) / b.value;
    return a * b.chain(inverse, -(inverse * inverse));
  }
};

inline double exp_of(double x) {
  return std::exp(x);
}
inline double log_of(double x) {
  return std::log(x);
}
inline double sqrt_of(double x) {
  return std::sqrt(x);
}
inline double number_of(double x) {
  return x;
}

template <class T, int N>
Dual<T, N> exp_of(const Dual<T, N>& x) {
  const T e = exp_of(x.value);
  return x.chain(e, e);
}
template <class T, int N>
Dual<T, N> log_of(const Dual<T, N>& x) {
  return x.chain(log_of(x.value), T(1.0) / x.value);
}
template <class T, int N>
Dual<T, N> sqrt_of(const Dual<T, N>& x) {
  const T root = sqrt_of(x.value);
  return x.chain(root, T(0.5) / root);
}
template <class T, int N>
double number_of(const Dual<T, N>& x) {
  return number_of(x.value);
}

/// x^p for x > 0, either may vary.
template <class T, class P>
auto power(const T& x, const P& p) {
  return exp_of(p * log_of(x));
}

/// What the laws of fem/ call, found by argument-dependent lookup.
template <class T, int N>
Dual<T, N> power_of(const Dual<T, N>& x, double exponent) {
  return exp_of(Dual<T, N>(exponent) * log_of(x));
}
template <class T, int N>
Dual<T, N> logarithm(const Dual<T, N>& x) {
  return log_of(x);
}
template <class T, int N>
Dual<T, N> exponential(const Dual<T, N>& x) {
  return exp_of(x);
}
template <class T, int N>
Dual<T, N> square_root(const Dual<T, N>& x) {
  return sqrt_of(x);
}
template <class T, int N>
double exceeds(const Dual<T, N>& x, double bound) {
  return number_of(x) > bound ? 1 : 0;
}

}  // namespace palpate::calibrate
