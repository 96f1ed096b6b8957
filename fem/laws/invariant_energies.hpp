// SPDX-License-Identifier: AGPL-3.0-or-later
// Isochoric energies W(x, y), x = I1 - 3 and y = I2 - 3 of the isochoric deformation, with their
// derivatives. Moduli in Pa.
#pragma once

#include <array>

#include "fem/laws/invariant_law.hpp"

namespace palpate::fem {

/// W = C10 x + C01 y [Rivlin 1948]. mu = 2 (C10 + C01).
struct MooneyRivlinEnergy {
  static constexpr bool kSecond = true;
  double C10, C01;

  bool polyconvex() const { return C10 > 0 && C01 == 0; }
  template <class T>
  T value(const T& x, const T& y) const {
    return C10 * x + C01 * y;
  }
  template <class T>
  InvariantSlopes<T> slopes(const T&, const T&) const {
    const T zero = zero_of<T>();
    return {constant_of<T>(C10), constant_of<T>(C01), zero, zero, zero};
  }
};

/// W = C10 x + C01 y + C20 x^2 + C11 x y + C02 y^2 [Rivlin & Saunders 1951].
/// mu = 2 (C10 + C01).
struct MooneyRivlin5Energy {
  static constexpr bool kSecond = true;
  double C10, C01, C20, C11, C02;

  bool polyconvex() const { return C10 > 0 && C20 >= 0 && C01 == 0 && C11 == 0 && C02 == 0; }
  template <class T>
  T value(const T& x, const T& y) const {
    return C10 * x + C01 * y + C20 * x * x + C11 * x * y + C02 * y * y;
  }
  template <class T>
  InvariantSlopes<T> slopes(const T& x, const T& y) const {
    return {C10 + 2 * C20 * x + C11 * y, C01 + C11 * x + 2 * C02 * y, constant_of<T>(2 * C20),
            constant_of<T>(C11), constant_of<T>(2 * C02)};
  }
};

/// W = C10 x + C20 x^2 + C30 x^3 [Yeoh 1993]. mu = 2 C10.
struct YeohEnergy {
  static constexpr bool kSecond = false;
  double C10, C20, C30;

  bool polyconvex() const { return C10 > 0 && C20 >= 0 && C30 >= 0; }
  template <class T>
  T value(const T& x, const T&) const {
    return x * (C10 + x * (C20 + C30 * x));
  }
  template <class T>
  InvariantSlopes<T> slopes(const T& x, const T&) const {
    const T zero = zero_of<T>();
    return {C10 + x * (2 * C20 + 3 * C30 * x), zero, 2 * C20 + 6 * C30 * x, zero, zero};
  }
};

/// W = mu/(2 b) (exp(b x) - 1) [Demiray 1972].
struct DemirayFungEnergy {
  static constexpr bool kSecond = false;
  double mu, b;

  bool polyconvex() const { return true; }
  template <class T>
  T value(const T& x, const T&) const {
    return (0.5 * mu / b) * (exponential(T(b * x)) - 1.0);
  }
  template <class T>
  InvariantSlopes<T> slopes(const T& x, const T&) const {
    const T zero = zero_of<T>(), W1 = (0.5 * mu) * exponential(T(b * x));
    return {W1, zero, b * W1, zero, zero};
  }
};

/// W = C1 (exp(C2 x) - 1) - C1 C2/2 y [Veronda & Westmann 1970]. mu = C1 C2.
struct VerondaWestmannEnergy {
  static constexpr bool kSecond = true;
  double C1, C2;

  bool polyconvex() const { return false; }
  template <class T>
  T value(const T& x, const T& y) const {
    return C1 * (exponential(T(C2 * x)) - 1.0) - (0.5 * C1 * C2) * y;
  }
  template <class T>
  InvariantSlopes<T> slopes(const T& x, const T&) const {
    const T zero = zero_of<T>(), W1 = (C1 * C2) * exponential(T(C2 * x));
    return {W1, constant_of<T>(-0.5 * C1 * C2), C2 * W1, zero, zero};
  }
};

/// Eight-chain network by its series to the fifth term [Arruda & Boyce 1993, eq. 26]:
///   W = mu' sum_k C_k/lambda_m^(2k-2) (I1^k - 3^k), with mu' such that mu is the modulus at rest.
struct ArrudaBoyceEnergy {
  static constexpr bool kSecond = false;
  static constexpr std::array<double, 5> kSeries{0.5, 1.0 / 20, 11.0 / 1050, 19.0 / 7000,
                                                 519.0 / 673750};
  double mu, lambda_m;

  bool polyconvex() const { return true; }
  /// Coefficient of I1^k, k = 1..5.
  std::array<double, 5> coefficients() const {
    std::array<double, 5> c{};
    double rest = 0, factor = 1, power_3 = 1;
    for (std::size_t k = 0; k < 5; ++k) {
      c[k] = kSeries[k] * factor;
      rest += 2 * static_cast<double>(k + 1) * c[k] * power_3;
      power_3 *= 3;
      factor /= lambda_m * lambda_m;
    }
    for (double& value : c) value *= mu / rest;
    return c;
  }
  template <class T>
  T value(const T& x, const T&) const {
    const auto c = coefficients();
    const T I1 = x + 3.0;
    T sum = zero_of<T>(), power = I1;
    double rest = 3;
    for (std::size_t k = 0; k < 5; ++k) {
      sum += c[k] * (power - rest);
      power = power * I1;
      rest *= 3;
    }
    return sum;
  }
  template <class T>
  InvariantSlopes<T> slopes(const T& x, const T&) const {
    const auto c = coefficients();
    const T zero = zero_of<T>(), I1 = x + 3.0;
    const T W1 = c[0] + I1 * (2 * c[1] + I1 * (3 * c[2] + I1 * (4 * c[3] + I1 * (5 * c[4]))));
    const T W11 = 2 * c[1] + I1 * (6 * c[2] + I1 * (12 * c[3] + I1 * (20 * c[4])));
    return {W1, zero, W11, zero, zero};
  }
};

using MooneyRivlin = InvariantLaw<MooneyRivlinEnergy>;
using MooneyRivlin5 = InvariantLaw<MooneyRivlin5Energy>;
using Yeoh = InvariantLaw<YeohEnergy>;
using DemirayFung = InvariantLaw<DemirayFungEnergy>;
using VerondaWestmann = InvariantLaw<VerondaWestmannEnergy>;
using ArrudaBoyce = InvariantLaw<ArrudaBoyceEnergy>;

}  // namespace palpate::fem
