// SPDX-License-Identifier: AGPL-3.0-or-later
// Isochoric energies W(x, y), x = I1 - 3 and y = I2 - 3 of the isochoric deformation, with their
// derivatives. Moduli in Pa. C is the scalar of the constants, T that of the invariants: C is
// double in the solver, and an automatic derivative in the calibration, where T is C.
#pragma once

#include <array>

#include "fem/laws/invariant_law.hpp"

namespace palpate::fem {

/// W = mu/2 x [Treloar 1943]. The solver has a kernel of its own for it (NeoHookean).
template <class C = double>
struct NeoHookeanEnergy {
  using Scalar = C;
  static constexpr bool kSecond = false;
  C mu;

  bool polyconvex() const { return true; }
  template <class T>
  T value(const T& x, const T&) const {
    return 0.5 * mu * x;
  }
  template <class T>
  InvariantSlopes<T> slopes(const T&, const T&) const {
    const T zero = zero_of<T>();
    return {constant_of<T>(C(0.5 * mu)), zero, zero, zero, zero};
  }
};

/// W = C10 x + C01 y [Rivlin 1948]. mu = 2 (C10 + C01).
template <class C = double>
struct MooneyRivlinEnergy {
  using Scalar = C;
  static constexpr bool kSecond = true;
  C C10, C01;

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
template <class C = double>
struct MooneyRivlin5Energy {
  using Scalar = C;
  static constexpr bool kSecond = true;
  C C10, C01, C20, C11, C02;

  bool polyconvex() const { return C10 > 0 && C20 >= 0 && C01 == 0 && C11 == 0 && C02 == 0; }
  template <class T>
  T value(const T& x, const T& y) const {
    return C10 * x + C01 * y + C20 * x * x + C11 * x * y + C02 * y * y;
  }
  template <class T>
  InvariantSlopes<T> slopes(const T& x, const T& y) const {
    return {C10 + 2.0 * C20 * x + C11 * y, C01 + C11 * x + 2.0 * C02 * y,
            constant_of<T>(C(2.0 * C20)), constant_of<T>(C11), constant_of<T>(C(2.0 * C02))};
  }
};

/// W = C10 x + C20 x^2 + C30 x^3 [Yeoh 1993]. mu = 2 C10.
template <class C = double>
struct YeohEnergy {
  using Scalar = C;
  static constexpr bool kSecond = false;
  C C10, C20, C30;

  bool polyconvex() const { return C10 > 0 && C20 >= 0 && C30 >= 0; }
  template <class T>
  T value(const T& x, const T&) const {
    return x * (C10 + x * (C20 + C30 * x));
  }
  template <class T>
  InvariantSlopes<T> slopes(const T& x, const T&) const {
    const T zero = zero_of<T>();
    return {C10 + x * (2.0 * C20 + 3.0 * C30 * x), zero, 2.0 * C20 + 6.0 * C30 * x, zero, zero};
  }
};

/// W = mu/(2 b) (exp(b x) - 1) [Demiray 1972].
template <class C = double>
struct DemirayFungEnergy {
  using Scalar = C;
  static constexpr bool kSecond = false;
  C mu, b;

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
template <class C = double>
struct VerondaWestmannEnergy {
  using Scalar = C;
  static constexpr bool kSecond = true;
  C C1, C2;

  bool polyconvex() const { return false; }
  template <class T>
  T value(const T& x, const T& y) const {
    return C1 * (exponential(T(C2 * x)) - 1.0) - (0.5 * C1 * C2) * y;
  }
  template <class T>
  InvariantSlopes<T> slopes(const T& x, const T&) const {
    const T zero = zero_of<T>(), W1 = (C1 * C2) * exponential(T(C2 * x));
    return {W1, constant_of<T>(C(-0.5 * C1 * C2)), C2 * W1, zero, zero};
  }
};

/// W = -mu J_m/2 ln(1 - x/J_m) [Gent 1996]. Chains of limited length: the energy grows without
/// bound towards x = J_m. Value and derivatives are NaN beyond, where the law has none.
template <class C = double>
struct GentEnergy {
  using Scalar = C;
  static constexpr bool kSecond = false;
  C mu, J_m;

  /// -ln(1 - x/J_m) is convex and increasing in x, which is polyconvex.
  bool polyconvex() const { return true; }
  template <class T>
  T value(const T& x, const T&) const {
    return (-0.5 * mu * J_m) * logarithm(T(1.0 - x / J_m));
  }
  template <class T>
  InvariantSlopes<T> slopes(const T& x, const T&) const {
    const T zero = zero_of<T>(), root = square_root(T(1.0 - x / J_m));
    const T W1 = 0.5 * mu / (root * root);
    return {W1, zero, W1 / (J_m * root * root), zero, zero};
  }
};

/// Eight-chain network by its series to the fifth term [Arruda & Boyce 1993, eq. 26]:
///   W = mu' sum_k C_k/lambda_m^(2k-2) (I1^k - 3^k), with mu' such that mu is the modulus at rest.
template <class C = double>
struct ArrudaBoyceEnergy {
  using Scalar = C;
  static constexpr bool kSecond = false;
  static constexpr std::array<double, 5> kSeries{0.5, 1.0 / 20, 11.0 / 1050, 19.0 / 7000,
                                                 519.0 / 673750};
  C mu, lambda_m;

  bool polyconvex() const { return true; }
  /// Coefficient of I1^k, k = 1..5.
  std::array<C, 5> coefficients() const {
    std::array<C, 5> c{};
    C rest(0.0), factor(1.0);
    double power_3 = 1;
    for (std::size_t k = 0; k < 5; ++k) {
      c[k] = kSeries[k] * factor;
      rest += 2.0 * static_cast<double>(k + 1) * c[k] * power_3;
      power_3 *= 3;
      factor /= lambda_m * lambda_m;
    }
    for (C& value : c) value *= mu / rest;
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
    const T W1 =
        c[0] + I1 * (2.0 * c[1] + I1 * (3.0 * c[2] + I1 * (4.0 * c[3] + I1 * (5.0 * c[4]))));
    const T W11 = 2.0 * c[1] + I1 * (6.0 * c[2] + I1 * (12.0 * c[3] + I1 * (20.0 * c[4])));
    return {W1, zero, W11, zero, zero};
  }
};

using MooneyRivlin = InvariantLaw<MooneyRivlinEnergy<>>;
using MooneyRivlin5 = InvariantLaw<MooneyRivlin5Energy<>>;
using Yeoh = InvariantLaw<YeohEnergy<>>;
using DemirayFung = InvariantLaw<DemirayFungEnergy<>>;
using VerondaWestmann = InvariantLaw<VerondaWestmannEnergy<>>;
using Gent = InvariantLaw<GentEnergy<>>;
using ArrudaBoyce = InvariantLaw<ArrudaBoyceEnergy<>>;

}  // namespace palpate::fem
