// SPDX-License-Identifier: AGPL-3.0-or-later
// Strain energies of incompressible isotropic laws as functions of the principal stretches, each a
// template over its scalar, so that stresses and their derivatives by the constants are exact.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "fitting/measurement/calibrate/dual.hpp"

namespace palpate::calibrate {

/// A constant of a law: what it is called, what it is measured in, where it makes sense.
struct ConstantInfo {
  std::string name;
  bool is_stress = true;  ///< in Pa; otherwise a pure number
  double start = 0;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

template <class T>
using Stretches = std::array<T, 3>;

template <class T>
T first_invariant(const Stretches<T>& l) {
  return l[0] * l[0] + l[1] * l[1] + l[2] * l[2];
}
/// Of an incompressible deformation: the sum of the squares of the inverse stretches.
template <class T>
T second_invariant(const Stretches<T>& l) {
  return T(1.0) / (l[0] * l[0]) + T(1.0) / (l[1] * l[1]) + T(1.0) / (l[2] * l[2]);
}

inline constexpr double kSmallModulus = 1e-3;  ///< Pa, lower bound of a modulus

/// W = mu/2 (I1 - 3) [Treloar 1943].
struct NeoHookeanEnergy {
  static constexpr int kConstants = 1;
  template <class T>
  T operator()(const T* c, const Stretches<T>& l) const {
    return T(0.5) * c[0] * (first_invariant(l) - T(3.0));
  }
};

/// W = C10 (I1 - 3) + C01 (I2 - 3) [Rivlin 1948].
struct MooneyRivlinEnergy {
  static constexpr int kConstants = 2;
  template <class T>
  T operator()(const T* c, const Stretches<T>& l) const {
    return c[0] * (first_invariant(l) - T(3.0)) + c[1] * (second_invariant(l) - T(3.0));
  }
};

/// W = C10 (I1 - 3) + C20 (I1 - 3)^2 + C30 (I1 - 3)^3 [Yeoh 1993].
struct YeohEnergy {
  static constexpr int kConstants = 3;
  template <class T>
  T operator()(const T* c, const Stretches<T>& l) const {
    const T i = first_invariant(l) - T(3.0);
    return c[0] * i + c[1] * i * i + c[2] * i * i * i;
  }
};

/// W = sum over N terms of 2 mu_i/alpha_i^2 (l1^a + l2^a + l3^a - 3) [Ogden 1972], with mu_i the
/// part of the term in the shear modulus: mu = sum mu_i. Ogden's own constants are 2 mu_i/alpha_i.
template <int N>
struct OgdenEnergy {
  static constexpr int kConstants = 2 * N;
  template <class T>
  T operator()(const T* c, const Stretches<T>& l) const {
    T sum(0.0);
    for (const T* term = c; term != c + kConstants; term += 2) {
      const T &mu = term[0], &alpha = term[1];
      const T powers = power(l[0], alpha) + power(l[1], alpha) + power(l[2], alpha) - T(3.0);
      sum = sum + T(2.0) * mu / (alpha * alpha) * powers;
    }
    return sum;
  }
};

/// W = mu/(2 b) (exp(b (I1 - 3)) - 1) [Demiray 1972].
struct DemirayFungEnergy {
  static constexpr int kConstants = 2;
  template <class T>
  T operator()(const T* c, const Stretches<T>& l) const {
    return T(0.5) * c[0] / c[1] * (exp_of(c[1] * (first_invariant(l) - T(3.0))) - T(1.0));
  }
};

/// W = C1 (exp(C2 (I1 - 3)) - 1) - C1 C2/2 (I2 - 3) [Veronda & Westmann 1970].
struct VerondaWestmannEnergy {
  static constexpr int kConstants = 2;
  template <class T>
  T operator()(const T* c, const Stretches<T>& l) const {
    return c[0] * (exp_of(c[1] * (first_invariant(l) - T(3.0))) - T(1.0)) -
           T(0.5) * c[0] * c[1] * (second_invariant(l) - T(3.0));
  }
};

/// W = -mu Jm/2 ln(1 - (I1 - 3)/Jm) [Gent 1996]. It has no value (NaN) beyond the limiting stretch,
/// I1 - 3 >= Jm.
struct GentEnergy {
  static constexpr int kConstants = 2;
  template <class T>
  T operator()(const T* c, const Stretches<T>& l) const {
    return T(-0.5) * c[0] * c[1] * log_of(T(1.0) - (first_invariant(l) - T(3.0)) / c[1]);
  }
};

/// Eight-chain network by its series to the fifth term [Arruda & Boyce 1993, eq. 26], locking
/// stretch lm: W = mu' sum_k C_k/lm^(2k-2) (I1^k - 3^k), with mu' such that mu is the modulus at
/// rest.
struct ArrudaBoyceEnergy {
  static constexpr int kConstants = 2;
  template <class T>
  T operator()(const T* c, const Stretches<T>& l) const {
    constexpr std::array<double, 5> series{0.5, 1.0 / 20, 11.0 / 1050, 19.0 / 7000, 519.0 / 673750};
    const T I1 = first_invariant(l), inverse = T(1.0) / (c[1] * c[1]);
    T sum(0.0), rest(0.0), factor(1.0), power_I1(1.0);
    double power_3 = 1;
    for (std::size_t k = 0; k < series.size(); ++k) {
      rest = rest + T(2 * static_cast<double>(k + 1) * series[k] * power_3) * factor;
      power_I1 = power_I1 * I1;
      power_3 *= 3;
      sum = sum + T(series[k]) * factor * (power_I1 - T(power_3));
      factor = factor * inverse;
    }
    return c[0] / rest * sum;
  }
};

}  // namespace palpate::calibrate
