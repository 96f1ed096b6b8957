// SPDX-License-Identifier: AGPL-3.0-or-later
// A law of each type with the constants of the samples, and its energy, stress and tangent as
// functions of the deformation gradient, for the tests of the laws.
#pragma once

#include <ceres/jet.h>

#include <Eigen/Geometry>
#include <random>
#include <stdexcept>
#include <string_view>

#include "fem/laws/invariant_energies.hpp"
#include "fem/laws/law.hpp"
#include "fem/laws/law_table.hpp"
#include "fem/laws/ogden.hpp"
#include "fem/laws/saint_venant_kirchhoff.hpp"
#include "format/to_index.hpp"
#include "tests/support/sample_laws.hpp"

namespace palpate::fem {

using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using Varied = ceres::Jet<double, 9>;

inline constexpr double kPoisson = 0.45;
inline const Fibres<double> kFibres{{{2.0 / 3, 2.0 / 3, 1.0 / 3}, {0.6, 0, -0.8}}};

/// The law of a type, with the constants of the sample.
template <class L>
struct Sample;

inline double constant(std::string_view law, std::string_view name) {
  for (const LawConstants& sample : test::sample_laws(kPoisson))
    if (sample.law == law) return sample.at(name);
  throw std::logic_error("no such law");
}

inline double bulk_modulus(std::string_view law) {
  for (const LawConstants& sample : test::sample_laws(kPoisson))
    if (sample.law == law) return rest_moduli(sample).kappa();
  throw std::logic_error("no such law");
}

template <>
struct Sample<NeoHookean> {
  static constexpr auto kName = "neo-hookean";
  static NeoHookean make() {
    return NeoHookean::from_young_poisson(constant(kName, "young"), kPoisson, kName);
  }
};
template <>
struct Sample<MooneyRivlin> {
  static constexpr auto kName = "mooney-rivlin";
  static MooneyRivlin make() {
    return {{.C10 = constant(kName, "C10"), .C01 = constant(kName, "C01")}, bulk_modulus(kName)};
  }
};
template <>
struct Sample<MooneyRivlin5> {
  static constexpr auto kName = "mooney-rivlin-5";
  static MooneyRivlin5 make() {
    return {{.C10 = constant(kName, "C10"),
             .C01 = constant(kName, "C01"),
             .C20 = constant(kName, "C20"),
             .C11 = constant(kName, "C11"),
             .C02 = constant(kName, "C02")},
            bulk_modulus(kName)};
  }
};
template <>
struct Sample<Yeoh> {
  static constexpr auto kName = "yeoh";
  static Yeoh make() {
    return {{.C10 = constant(kName, "C10"),
             .C20 = constant(kName, "C20"),
             .C30 = constant(kName, "C30")},
            bulk_modulus(kName)};
  }
};
template <>
struct Sample<Ogden> {
  static constexpr auto kName = "ogden-3";
  static Ogden make() {
    return {{{constant(kName, "mu_1"), constant(kName, "alpha_1")},
             {constant(kName, "mu_2"), constant(kName, "alpha_2")},
             {constant(kName, "mu_3"), constant(kName, "alpha_3")}},
            bulk_modulus(kName)};
  }
};
template <>
struct Sample<DemirayFung> {
  static constexpr auto kName = "demiray-fung";
  static DemirayFung make() {
    return {{.mu = constant(kName, "mu"), .b = constant(kName, "b")}, bulk_modulus(kName)};
  }
};
template <>
struct Sample<VerondaWestmann> {
  static constexpr auto kName = "veronda-westmann";
  static VerondaWestmann make() {
    return {{.C1 = constant(kName, "C1"), .C2 = constant(kName, "C2")}, bulk_modulus(kName)};
  }
};
template <>
struct Sample<Gent> {
  static constexpr auto kName = "gent";
  static Gent make() {
    return {{.mu = constant(kName, "mu"), .J_m = constant(kName, "J_m")}, bulk_modulus(kName)};
  }
};
template <>
struct Sample<ArrudaBoyce> {
  static constexpr auto kName = "arruda-boyce";
  static ArrudaBoyce make() {
    return {{.mu = constant(kName, "mu"), .lambda_m = constant(kName, "lambda_m")},
            bulk_modulus(kName)};
  }
};
template <>
struct Sample<SaintVenantKirchhoff> {
  static constexpr auto kName = "saint-venant-kirchhoff";
  static SaintVenantKirchhoff make() {
    const double E = constant(kName, "young"), mu = E / (2 * (1 + kPoisson));
    return {2 * mu * kPoisson / (1 - 2 * kPoisson), mu};
  }
};
template <>
struct Sample<HolzapfelGasserOgden> {
  static constexpr auto kName = "holzapfel-gasser-ogden";
  static HolzapfelGasserOgden make() {
    FibreField two;
    two.families = 2;
    return {{.c = constant(kName, "c"),
             .k1 = constant(kName, "k1"),
             .k2 = constant(kName, "k2"),
             .dispersion = constant(kName, "kappa")},
            two,
            bulk_modulus(kName)};
  }
};

template <class T>
Tensor2<T> to_tensor(const Matrix& m) {
  Tensor2<T> t;
  for (int i = 0; i < 9; ++i) t[to_index(i)] = T(m(i / 3, i % 3));
  return t;
}
inline Tensor2<double> to_tensor(const Matrix& m) {
  return to_tensor<double>(m);
}
inline Matrix to_matrix(const Tensor2<double>& t) {
  return Eigen::Map<const Matrix>(t.data());
}

template <class T>
Fibres<T> to_fibres(const Fibres<double>& a) {
  Fibres<T> b;
  for (std::size_t f = 0; f < 2; ++f)
    for (std::size_t i = 0; i < 3; ++i) b[f][i] = T(a[f][i]);
  return b;
}

/// Full energy density, isochoric and volumetric.
template <class T, class L>
T energy(const L& law, const Tensor2<T>& F, const Fibres<double>& a = kFibres) {
  const T J = determinant(F, cofactor(F));
  if constexpr (Anisotropic<L>)
    return law.psi(F, J, to_fibres<T>(a)) + law.volumetric_energy(J);
  else
    return law.psi(F, J) + law.volumetric_energy(J);
}

template <class T, class L>
Tensor2<T> isochoric_stress(const L& law, const Tensor2<T>& F, const Fibres<double>& a = kFibres) {
  const Tensor2<T> cof = cofactor(F);
  const T J = determinant(F, cof);
  if constexpr (Anisotropic<L>)
    return law.piola(F, cof, J, to_fibres<T>(a));
  else
    return law.piola(F, cof, J);
}

/// Full first Piola-Kirchhoff stress.
template <class T, class L>
Tensor2<T> stress(const L& law, const Tensor2<T>& F, const Fibres<double>& a = kFibres) {
  Tensor2<T> P = isochoric_stress(law, F, a);
  const Tensor2<T> cof = cofactor(F);
  const T p = law.pressure(determinant(F, cof));
  for (std::size_t i = 0; i < 9; ++i) P[i] += p * cof[i];
  return P;
}

template <class L>
Tensor4<double> isochoric_tangent(const L& law, const Matrix& F,
                                  const Fibres<double>& a = kFibres) {
  Tensor4<double> A{};
  const auto t = to_tensor(F);
  const auto cof = cofactor(t);
  if constexpr (Anisotropic<L>)
    law.add_tangent(t, cof, determinant(t, cof), a, A);
  else
    law.add_tangent(t, cof, determinant(t, cof), A);
  return A;
}

/// Derivative by the i-th entry of the deformation gradient.
inline double slope(const Varied& value, std::size_t i) {
  return value.v[static_cast<Eigen::Index>(i)];
}

inline Tensor2<Varied> varied(const Matrix& F) {
  Tensor2<Varied> t;
  for (int i = 0; i < 9; ++i) t[to_index(i)] = Varied(F(i / 3, i % 3), i);
  return t;
}

inline Matrix random_gradient(std::mt19937& random) {
  std::uniform_real_distribution<double> entry(-0.3, 0.3);
  Matrix F;
  do {
    F = Matrix::Identity();
    for (int i = 0; i < 9; ++i) F(i / 3, i % 3) += entry(random);
  } while (F.determinant() < 0.3);
  return F;
}

inline Matrix random_rotation(std::mt19937& random) {
  std::normal_distribution<double> entry;
  return Eigen::Quaterniond(entry(random), entry(random), entry(random), entry(random))
      .normalized()
      .toRotationMatrix();
}

}  // namespace palpate::fem
