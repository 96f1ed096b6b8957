// SPDX-License-Identifier: AGPL-3.0-or-later
// Stress of an incompressible isotropic solid in homogeneous deformations. The sides are free of
// stress, so the work along the family of deformations is all that counts: with W(s) the energy
// along it, the nominal stress is dW/ds, per loaded direction. That holds for any energy.
#pragma once

#include <array>
#include <vector>

#include "fitting/measurement/calibrate/dual.hpp"

namespace palpate::calibrate {

enum class Mode {
  Uniaxial,     ///< stretches s, s^-1/2, s^-1/2
  Equibiaxial,  ///< s, s, s^-2
  PureShear,    ///< s, 1, 1/s
  SimpleShear   ///< amount of shear s: principal stretches s/2 + sqrt(1 + s^2/4), 1 and inverse
};

template <class T>
std::array<T, 3> stretches(Mode mode, const T& s) {
  switch (mode) {
    case Mode::Uniaxial: {
      const T side = T(1.0) / sqrt_of(s);
      return {s, side, side};
    }
    case Mode::Equibiaxial:
      return {s, s, T(1.0) / (s * s)};
    case Mode::PureShear:
      return {s, T(1.0), T(1.0) / s};
    case Mode::SimpleShear:
      break;
  }
  const T half = T(0.5) * s;
  const T l = half + sqrt_of(T(1.0) + half * half);
  return {l, T(1.0), T(1.0) / l};
}

/// The amount of deformation at rest: 1 for a stretch, 0 for a shear.
inline double rest_of(Mode mode) {
  return mode == Mode::SimpleShear ? 0 : 1;
}

/// Nominal stress at s, in the unit of the energy: dW/ds, halved where two directions are loaded.
/// `energy` is callable with std::array<S, 3> of stretches for S = Dual<T, 1>.
template <class T, class Energy>
T nominal_stress(const Energy& energy, Mode mode, const T& s) {
  const Dual<T, 1> varied(s, 0);
  const Dual<T, 1> W = energy(stretches(mode, varied));
  return mode == Mode::Equibiaxial ? T(0.5) * W.slope[0] : W.slope[0];
}

/// Cauchy over nominal stress: the loaded stretch (the area of a simple shear does not change).
inline double cauchy_over_nominal(Mode mode, double s) {
  return mode == Mode::SimpleShear ? 1 : s;
}

/// Smaller eigenvalue of the Hessian of W by the logarithmic strains (e1, e2), e3 = -e1 - e2, at
/// these stretches: the law resists every small further deformation where it is positive
/// [Drucker 1957; as a test of fitted rubber laws, Ogden 1972].
template <class Energy>
double least_tangent(const Energy& energy, const std::array<double, 3>& l) {
  using Inner = Dual<double, 2>;
  using Outer = Dual<Inner, 2>;
  std::array<Outer, 3> strain;
  for (int i = 0; i < 2; ++i) {
    const Inner e(std::log(l[static_cast<std::size_t>(i)]), i);
    strain[static_cast<std::size_t>(i)] = Outer(e, i);
  }
  strain[2] = -strain[0] - strain[1];
  const Outer W =
      energy(std::array<Outer, 3>{exp_of(strain[0]), exp_of(strain[1]), exp_of(strain[2])});
  const double a = W.slope[0].slope[0], b = W.slope[0].slope[1], d = W.slope[1].slope[1];
  return 0.5 * (a + d) - std::sqrt(0.25 * (a - d) * (a - d) + b * b);
}

}  // namespace palpate::calibrate
