// SPDX-License-Identifier: AGPL-3.0-or-later
// Homogeneous deformations of an incompressible isotropic solid whose unloaded faces are free. A
// pressure does no work in them, so that the nominal stress per loaded direction is
//   dW/ds = sum_i tau_i de_i/ds,
// with the principal Kirchhoff stresses tau_i up to a pressure and the logarithmic strains e_i.
// Confined compression changes the volume. There the e_i are those of the isochoric part, and the
// volumetric part is added by the law.
#pragma once

#include <array>
#include <cmath>

namespace palpate::calibrate {

enum class Mode {
  Uniaxial,     ///< stretches s, s^-1/2, s^-1/2
  Equibiaxial,  ///< s, s, s^-2
  PureShear,    ///< s, 1, 1/s
  Confined,     ///< s, 1, 1, in a chamber with smooth walls
  SimpleShear   ///< amount of shear s: principal stretches s/2 + sqrt(1 + s^2/4), 1 and inverse
};

constexpr const char* mode_name(Mode mode) {
  switch (mode) {
    case Mode::Uniaxial:
      return "uniaxial";
    case Mode::Equibiaxial:
      return "equibiaxial";
    case Mode::PureShear:
      return "pure shear";
    case Mode::Confined:
      return "confined compression";
    case Mode::SimpleShear:
      break;
  }
  return "simple shear";
}

/// e_i over ln s; in simple shear over the largest of them, e_1.
inline std::array<double, 3> strain_ratios(Mode mode) {
  switch (mode) {
    case Mode::Uniaxial:
      return {1, -0.5, -0.5};
    case Mode::Equibiaxial:
      return {1, 1, -2};
    case Mode::Confined:
      return {2.0 / 3, -1.0 / 3, -1.0 / 3};
    case Mode::PureShear:
    case Mode::SimpleShear:
      break;
  }
  return {1, 0, -1};
}

/// Principal logarithmic strains at the amount of deformation s.
inline std::array<double, 3> logarithmic_strains(Mode mode, double s) {
  const double first = mode == Mode::SimpleShear ? std::asinh(s / 2) : std::log(s);
  std::array<double, 3> strain = strain_ratios(mode);
  for (double& e : strain) e *= first;
  return strain;
}

/// The amount of deformation at rest: 1 for a stretch, 0 for a shear.
inline double rest_of(Mode mode) {
  return mode == Mode::SimpleShear ? 0 : 1;
}

/// Nominal stress at s, in the unit of tau: dW/ds, halved where two directions are loaded.
template <class T>
T nominal_stress(const std::array<T, 3>& tau, Mode mode, double s) {
  const std::array<double, 3> ratio = strain_ratios(mode);
  const double rate = mode == Mode::SimpleShear ? 1 / std::sqrt(4 + s * s) : 1 / s;
  const T work = tau[0] * ratio[0] + tau[1] * ratio[1] + tau[2] * ratio[2];
  return work * (mode == Mode::Equibiaxial ? 0.5 * rate : rate);
}

/// Cauchy over nominal stress: the loaded stretch (the area of a simple shear does not change).
inline double cauchy_over_nominal(Mode mode, double s) {
  return mode == Mode::SimpleShear ? 1 : s;
}

}  // namespace palpate::calibrate
