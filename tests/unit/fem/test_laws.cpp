// SPDX-License-Identifier: AGPL-3.0-or-later
// Every law against its own definition: automatic differentiation of its energy, rotations, limits
// in which it becomes another law, and the closed forms of the incompressible solid.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "fem/at.hpp"
#include "fem/laws/invariant_energies.hpp"
#include "fem/laws/law.hpp"
#include "fem/laws/law_table.hpp"
#include "fem/laws/ogden.hpp"
#include "fem/laws/saint_venant_kirchhoff.hpp"
#include "fitting/calibrate/dual.hpp"
#include "format/error.hpp"
#include "tests/support/sample_laws.hpp"

namespace palpate::fem {
namespace {

using testing::HasSubstr;
using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using Varied = calibrate::Dual<double, 9>;

constexpr double kPoisson = 0.45;
const Fibres<double> kFibres{{{2.0 / 3, 2.0 / 3, 1.0 / 3}, {0.6, 0, -0.8}}};

/// The law of a type, with the constants of the sample.
template <class L>
struct Sample;

double constant(std::string_view law, std::string_view name) {
  for (const LawConstants& sample : test::sample_laws(kPoisson))
    if (sample.law == law) return sample.at(name);
  throw std::logic_error("no such law");
}

double bulk_modulus(std::string_view law) {
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
  for (int i = 0; i < 9; ++i) t[at(i)] = T(m(i / 3, i % 3));
  return t;
}
Tensor2<double> to_tensor(const Matrix& m) {
  return to_tensor<double>(m);
}
Matrix to_matrix(const Tensor2<double>& t) {
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

Tensor2<Varied> varied(const Matrix& F) {
  Tensor2<Varied> t;
  for (int i = 0; i < 9; ++i) t[at(i)] = Varied(F(i / 3, i % 3), i);
  return t;
}

Matrix random_gradient(std::mt19937& random) {
  std::uniform_real_distribution<double> entry(-0.3, 0.3);
  Matrix F;
  do {
    F = Matrix::Identity();
    for (int i = 0; i < 9; ++i) F(i / 3, i % 3) += entry(random);
  } while (F.determinant() < 0.3);
  return F;
}

Matrix random_rotation(std::mt19937& random) {
  std::normal_distribution<double> entry;
  return Eigen::Quaterniond(entry(random), entry(random), entry(random), entry(random))
      .normalized()
      .toRotationMatrix();
}

template <class L>
class EveryLaw : public testing::Test {};

using Laws =
    testing::Types<NeoHookean, MooneyRivlin, MooneyRivlin5, Yeoh, Ogden, DemirayFung,
                   VerondaWestmann, ArrudaBoyce, SaintVenantKirchhoff, HolzapfelGasserOgden>;
TYPED_TEST_SUITE(EveryLaw, Laws);

TYPED_TEST(EveryLaw, RestIsStressFree) {
  const auto law = Sample<TypeParam>::make();
  for (const double p : stress(law, to_tensor(Matrix::Identity()))) EXPECT_NEAR(p, 0, 1e-10);
  EXPECT_NEAR(energy(law, to_tensor(Matrix::Identity())), 0, 1e-10);
}

TYPED_TEST(EveryLaw, SmallStrainModuliAreThoseOfTheTable) {
  const auto law = Sample<TypeParam>::make();
  for (const LawConstants& sample : test::sample_laws(kPoisson)) {
    if (sample.law != Sample<TypeParam>::kName) continue;
    const RestModuli rest = rest_moduli(sample);
    const double h = 1e-6;
    // A shear that is slack in every fibre to first order would be a special direction: the
    // tangent at rest itself, where fibres do not act yet, and a swelling that holds them slack.
    const Tensor4<double> A = isochoric_tangent(law, Matrix::Identity());
    EXPECT_NEAR(A[1][1], rest.mu(), 1e-6 * rest.mu());
    EXPECT_NEAR(A[5][7], rest.mu(), 1e-6 * rest.mu());
    const Matrix shrunk = (1 - h) * Matrix::Identity();
    EXPECT_NEAR(stress(law, to_tensor(shrunk))[0] / (-3 * h), rest.kappa(), 1e-4 * rest.kappa());
  }
}

TYPED_TEST(EveryLaw, StressIsTheDerivativeOfTheEnergy) {
  const auto law = Sample<TypeParam>::make();
  std::mt19937 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Matrix F = random_gradient(random);
    const auto P = stress(law, to_tensor(F));
    const Varied W = energy(law, varied(F));
    const double scale = to_matrix(P).norm();
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(P[i], W.slope[i], 1e-9 * scale);
  }
}

TYPED_TEST(EveryLaw, TangentIsTheDerivativeOfTheStress) {
  const auto law = Sample<TypeParam>::make();
  std::mt19937 random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const Matrix F = random_gradient(random);
    const Tensor4<double> A = isochoric_tangent(law, F);
    const Tensor2<Varied> P = isochoric_stress(law, varied(F));
    double scale = 0;
    for (const auto& row : A)
      for (const double entry : row) scale = std::max(scale, std::abs(entry));
    for (std::size_t i = 0; i < 9; ++i)
      for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(A[i][k], P[i].slope[k], 1e-9 * scale);
  }
}

TYPED_TEST(EveryLaw, TangentHoldsWhereStretchesAreEqual) {
  const auto law = Sample<TypeParam>::make();
  std::mt19937 random(3);
  for (const auto& stretches : {Eigen::Vector3d(1.2, 1.2, 0.8), Eigen::Vector3d(0.9, 0.9, 0.9),
                                Eigen::Vector3d(1.1, 1.1 + 1e-7, 0.9)}) {
    // A swelling strains no fibre: that is where the tension switch acts.
    if (Anisotropic<TypeParam> && stretches[0] == stretches[2]) continue;
    const Matrix F = random_rotation(random) * stretches.asDiagonal() * random_rotation(random);
    const Tensor4<double> A = isochoric_tangent(law, F);
    double scale = 0;
    for (const auto& row : A)
      for (const double entry : row) scale = std::max(scale, std::abs(entry));
    for (int k = 0; k < 9; ++k) {
      const double h = 1e-5;
      Matrix plus = F, minus = F;
      plus(k / 3, k % 3) += h;
      minus(k / 3, k % 3) -= h;
      const auto high = isochoric_stress(law, to_tensor(plus));
      const auto low = isochoric_stress(law, to_tensor(minus));
      for (std::size_t i = 0; i < 9; ++i)
        EXPECT_NEAR(A[i][at(k)], (high[i] - low[i]) / (2 * h), 2e-8 * scale);
    }
  }
}

TYPED_TEST(EveryLaw, IsObjective) {
  const auto law = Sample<TypeParam>::make();
  std::mt19937 random(4);
  for (int trial = 0; trial < 20; ++trial) {
    const Matrix F = random_gradient(random), R = random_rotation(random);
    const double W = energy(law, to_tensor(F));
    EXPECT_NEAR(energy(law, to_tensor(R * F)), W, 1e-10 * W);
    const Matrix P = to_matrix(stress(law, to_tensor(F)));
    EXPECT_LT((to_matrix(stress(law, to_tensor(R * F))) - R * P).norm(), 1e-10 * P.norm());
  }
}

Fibres<double> rotated(const Matrix& R, const Fibres<double>& a) {
  Fibres<double> b;
  for (std::size_t f = 0; f < 2; ++f)
    Eigen::Map<Eigen::Vector3d>(b[f].data()) = R * Eigen::Map<const Eigen::Vector3d>(a[f].data());
  return b;
}

TYPED_TEST(EveryLaw, HasTheSymmetryOfItsMaterial) {
  const auto law = Sample<TypeParam>::make();
  std::mt19937 random(5);
  for (int trial = 0; trial < 20; ++trial) {
    const Matrix F = random_gradient(random), R = random_rotation(random);
    const double W = energy(law, to_tensor(F));
    if constexpr (!Anisotropic<TypeParam>) {
      EXPECT_NEAR(energy(law, to_tensor(F * R)), W, 1e-10 * W);
    } else {
      // Turned with its fibres it is the same body, turned without them another; a body of one
      // family may be spun about that and mirrored across it.
      EXPECT_NEAR(energy(law, to_tensor(F * R.transpose()), rotated(R, kFibres)), W, 1e-10 * W);
      EXPECT_GT(std::abs(energy(law, to_tensor(F * R.transpose())) - W), 1e-6 * W);
      const Eigen::Vector3d a(kFibres[0].data());
      const Fibres<double> one{kFibres[0], kFibres[0]};
      const double single = energy(law, to_tensor(F), one);
      const Matrix spin = Eigen::AngleAxisd(0.3 + trial, a).toRotationMatrix();
      const Matrix turn_over = Eigen::AngleAxisd(M_PI, a.unitOrthogonal()).toRotationMatrix();
      EXPECT_NEAR(energy(law, to_tensor(F * spin), one), single, 1e-10 * single);
      EXPECT_NEAR(energy(law, to_tensor(F * turn_over), one), single, 1e-10 * single);
    }
  }
}

/// Nominal stress of the incompressible solid: with tau_i = lambda_i P_i and the third face free,
/// (tau_1 - tau_3)/lambda_1.
template <class L>
double nominal(const L& law, double l1, double l2, const Fibres<double>& a = kFibres) {
  const Eigen::Vector3d l(l1, l2, 1 / (l1 * l2));
  const Matrix F = l.asDiagonal();
  const auto P = isochoric_stress(law, to_tensor(F), a);
  return (l[0] * P[0] - l[2] * P[8]) / l[0];
}

struct ClosedForms {
  double compressed, uniaxial, equibiaxial, pure_shear;
};

template <class L>
void expect_closed_forms(const L& law, const ClosedForms& expected, double stretch) {
  const auto near = [](double value, double reference) {
    EXPECT_NEAR(value, reference, 2e-6 * std::max(1.0, std::abs(reference)));
  };
  if (expected.compressed != 0) near(nominal(law, 0.9, 1 / std::sqrt(0.9)), expected.compressed);
  near(nominal(law, stretch, 1 / std::sqrt(stretch)), expected.uniaxial);
  near(nominal(law, stretch, stretch), expected.equibiaxial);
  near(nominal(law, stretch, 1), expected.pure_shear);
}

/// UT P = 2 (l - l^-2)(W1 + W2/l); ET 2 (l - l^-5)(W1 + l^2 W2); PS 2 (l - l^-3)(W1 + W2), W1 and
/// W2 written anew here.
template <class Slopes>
ClosedForms closed_forms(Slopes slopes, double stretch) {
  const auto invariants = [](double a, double b) {
    const double c = 1 / (a * b);
    return std::pair{a * a + b * b + c * c, 1 / (a * a) + 1 / (b * b) + 1 / (c * c)};
  };
  const auto uniaxial = [&](double l) {
    const auto [I1, I2] = invariants(l, 1 / std::sqrt(l));
    const auto [W1, W2] = slopes(I1, I2);
    return 2 * (l - 1 / (l * l)) * (W1 + W2 / l);
  };
  const double l = stretch;
  const auto [E1, E2] = invariants(l, l);
  const auto [B1, B2] = slopes(E1, E2);
  const auto [S1, S2] = invariants(l, 1);
  const auto [P1, P2] = slopes(S1, S2);
  return {uniaxial(0.9), uniaxial(l), 2 * (l - std::pow(l, -5)) * (B1 + l * l * B2),
          2 * (l - std::pow(l, -3)) * (P1 + P2)};
}

// Printed values computed independently of this program, nominal stress at a stretch of 0.9
// (uniaxial) and 1.3.
TEST(ClosedFormOf, NeoHookean) {
  expect_closed_forms(NeoHookean::from_moduli(1, 0), {-0.334568, 0.708284, 1.030671, 0.844834},
                      1.3);
}
TEST(ClosedFormOf, MooneyRivlin) {
  expect_closed_forms(MooneyRivlin({.C10 = 0.4, .C01 = 0.1}, 0),
                      {-0.342003, 0.675594, 1.172904, 0.844834}, 1.3);
}
TEST(ClosedFormOf, Yeoh) {
  expect_closed_forms(Yeoh({.C10 = 0.5, .C20 = -0.02, .C30 = 0.003}, 0),
                      {-0.333712, 0.696004, 0.980359, 0.827000}, 1.3);
}
TEST(ClosedFormOf, DemirayFung) {
  expect_closed_forms(DemirayFung({.mu = 1, .b = 3}, 0), {-0.368524, 1.405614, 9.212796, 1.967045},
                      1.3);
}
TEST(ClosedFormOf, VerondaWestmann) {
  expect_closed_forms(VerondaWestmann({.C1 = 0.25, .C2 = 4}, 0),
                      {-0.389443, 2.987940, 36.497640, 4.369419}, 1.3);
}
TEST(ClosedFormOf, OgdenOnTreloarsRubber) {
  // Printed with Ogden's own constants mu_p, W = sum mu_p/alpha_p (...); here 2 mu_p/alpha_p of
  // this program stands for them. Five digits are printed.
  const Ogden law({{0.63 * 1.3 / 2, 1.3}, {0.0012 * 5 / 2, 5}, {-0.01 * -2 / 2, -2}}, 0);
  EXPECT_NEAR(nominal(law, 2, 1 / std::sqrt(2)), 0.60272, 6e-6);
  EXPECT_NEAR(nominal(law, 2, 2), 0.82161, 6e-6);
  EXPECT_NEAR(nominal(law, 2, 1), 0.68562, 6e-6);
}
TEST(ClosedFormOf, FiveTermMooneyRivlin) {
  const auto slopes = [](double I1, double I2) {
    const double x = I1 - 3, y = I2 - 3;
    return std::pair{0.31 + 2 * 3.80 * x + 2.25 * y, 0.30 + 2.25 * x + 2 * 4.72 * y};
  };
  // Breast fat [Samani & Plewes 2004], kPa.
  expect_closed_forms(
      MooneyRivlin5({.C10 = 0.31, .C01 = 0.30, .C20 = 3.80, .C11 = 2.25, .C02 = 4.72}, 0),
      closed_forms(slopes, 1.3), 1.3);
}
TEST(ClosedFormOf, ArrudaBoyce) {
  // The limit of the inverse Langevin function at small stretch: mu' = mu/(1 + 3/(5 N) + 99/(175
  // N^2) + 513/(875 N^3) + 42039/(67375 N^4)), N = lambda_m^2.
  const double N = 4;
  const double factor = 1 / (1 + 3 / (5 * N) + 99 / (175 * N * N) + 513 / (875 * N * N * N) +
                             42039 / (67375 * N * N * N * N));
  const auto slopes = [&](double I1, double) {
    return std::pair{factor * (0.5 + I1 / (10 * N) + 33 * I1 * I1 / (1050 * N * N) +
                               76 * std::pow(I1, 3) / (7000 * std::pow(N, 3)) +
                               2595 * std::pow(I1, 4) / (673750 * std::pow(N, 4))),
                     0.0};
  };
  expect_closed_forms(ArrudaBoyce({.mu = 1, .lambda_m = 2}, 0), closed_forms(slopes, 1.5), 1.5);
}
TEST(ClosedFormOf, FibresPulledAlongTheirDirection) {
  // P = c (l - l^-2) + 2 k1 E exp(k2 E^2) l, E = l^2 - 1; slack when compressed.
  const HolzapfelGasserOgden law({.c = 1, .k1 = 0.8, .k2 = 0.5, .dispersion = 0}, FibreField{}, 0);
  const Fibres<double> along_x{{{1, 0, 0}, {1, 0, 0}}};
  const double l = 1.2, E = l * l - 1;
  EXPECT_NEAR(nominal(law, l, 1 / std::sqrt(l), along_x),
              l - 1 / (l * l) + 1.6 * E * std::exp(0.5 * E * E) * l, 1e-12);
  EXPECT_NEAR(nominal(law, 0.9, 1 / std::sqrt(0.9), along_x), 0.9 - 1 / 0.81, 1e-12);
}
TEST(ClosedFormOf, ArteryMediaByHolzapfel2000) {
  // Two families at +-29 degrees of the circumference, stretched along it with the thickness free
  // and the axial stretch held: tau_1 - tau_3 = c (l1^2 - l3^2) + 4 k1 E exp(k2 E^2) l1^2 cos^2.
  const double angle = 29 * M_PI / 180, c2 = std::pow(std::cos(angle), 2);
  FibreField field;
  field.angle = angle;
  field.families = 2;
  const HolzapfelGasserOgden law({.c = 3.0, .k1 = 2.3632, .k2 = 0.8393, .dispersion = 0}, field, 0);
  const auto a = field.at({});
  const double l = 1.25, l3 = 1 / l, E = l * l * c2 + (1 - c2) - 1;
  EXPECT_NEAR(
      nominal(law, l, 1, {{a[0], a[1]}}),
      (3.0 * (l * l - l3 * l3) + 4 * 2.3632 * E * std::exp(0.8393 * E * E) * l * l * c2) / l,
      1e-12);
}
TEST(ClosedFormOf, SaintVenantKirchhoffUniaxial) {
  // P = l E (l^2 - 1)/2, sides l_s^2 = 1 - nu (l^2 - 1).
  const double E = 10e3, nu = 0.3, mu = E / (2 * (1 + nu));
  const SaintVenantKirchhoff law(2 * mu * nu / (1 - 2 * nu), mu);
  for (const double l : {0.8, 1.3}) {
    const double side = std::sqrt(1 - nu * (l * l - 1));
    const Matrix F = Eigen::Vector3d(l, side, side).asDiagonal();
    const auto P = stress(law, to_tensor(F));
    EXPECT_NEAR(P[0], l * E * (l * l - 1) / 2, 1e-9 * E);
    EXPECT_NEAR(P[8], 0, 1e-9 * E);
  }
}

/// Closed forms of the incompressible neo-Hookean solid with mu = 1, nominal stress: uniaxial
/// P = l - l^-2, equibiaxial l - l^-5, pure shear l - l^-3. The compressibility left at
/// nu = 0.499999 changes them by less than 1e-4.
TEST(ClosedFormOf, NeoHookeanIsApproachedNearlyIncompressible) {
  const auto law = NeoHookean::from_young_poisson(2 * (1 + 0.499999), 0.499999, "test");
  // Loaded stretches given, the free one found by bisection on a traction-free face.
  const auto loaded = [&](double a, bool a_free_twice, double b) {
    double low = 0.3, high = 2;
    for (int i = 0; i < 200; ++i) {
      const double free = 0.5 * (low + high);
      const Matrix F = Eigen::Vector3d(a, a_free_twice ? free : b, free).asDiagonal();
      (stress(law, to_tensor(F))[8] < 0 ? low : high) = free;
    }
    const Matrix F = Eigen::Vector3d(a, a_free_twice ? low : b, low).asDiagonal();
    return stress(law, to_tensor(F))[0];
  };
  EXPECT_NEAR(loaded(0.9, true, 0), -0.334568, 1e-4);
  EXPECT_NEAR(loaded(1.3, true, 0), 0.708284, 1e-4);
  EXPECT_NEAR(loaded(1.3, false, 1.3), 1.030671, 2e-4);
  EXPECT_NEAR(loaded(1.3, false, 1.0), 0.844834, 1e-4);
}

/// sigma_12 = 2 g (W1 + W2); with sigma_33 = 0, sigma_11 = 2 g^2 W1 and sigma_22 = -2 g^2 W2.
TEST(SimpleShear, FollowsTheClosedForm) {
  const double g = 0.7, I1 = 3 + g * g;
  Matrix F = Matrix::Identity();
  F(0, 1) = g;
  const auto check = [&](const auto& law, double W1, double W2) {
    const Matrix s = to_matrix(isochoric_stress(law, to_tensor(F))) * F.transpose();
    EXPECT_NEAR(s(0, 1), 2 * g * (W1 + W2), 1e-12);
    EXPECT_NEAR(s(0, 0) - s(2, 2), 2 * g * g * W1, 1e-12);
    EXPECT_NEAR(s(1, 1) - s(2, 2), -2 * g * g * W2, 1e-12);
  };
  const double x = I1 - 3;
  check(NeoHookean::from_moduli(1, 0), 0.5, 0);
  check(MooneyRivlin({.C10 = 0.4, .C01 = 0.1}, 0), 0.4, 0.1);
  check(MooneyRivlin5({.C10 = 0.4, .C01 = 0.1, .C20 = 0.2, .C11 = 0.3, .C02 = 0.05}, 0),
        0.4 + 0.4 * x + 0.3 * x, 0.1 + 0.3 * x + 0.1 * x);
  check(Yeoh({.C10 = 0.5, .C20 = -0.02, .C30 = 0.003}, 0), 0.5 - 0.04 * x + 0.009 * x * x, 0);
  check(DemirayFung({.mu = 1, .b = 3}, 0), 0.5 * std::exp(3 * x), 0);
  check(VerondaWestmann({.C1 = 0.25, .C2 = 4}, 0), std::exp(4 * x), -0.5);
  // In principal stretches, as functions of the invariants: alpha = 2 is I1, alpha = -2 is I2.
  check(Ogden({{0.8, 2}, {0.2, -2}}, 0), 0.4, 0.1);
}

/// Where a law has a simpler one as its limit, it must be that one, in stress and tangent.
TEST(Limits, BecomeNeoHookean) {
  const double mu = 3e3, kappa = 5e4;
  const auto reference = NeoHookean::from_moduli(mu, kappa);
  std::mt19937 random(6);
  const auto expect_same = [&](const auto& law, double tolerance) {
    for (int trial = 0; trial < 10; ++trial) {
      const Matrix F = random_gradient(random);
      const auto P = stress(law, to_tensor(F)), P0 = stress(reference, to_tensor(F));
      const auto A = isochoric_tangent(law, F), A0 = isochoric_tangent(reference, F);
      for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_NEAR(P[i], P0[i], tolerance * mu);
        for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(A[i][k], A0[i][k], 10 * tolerance * mu);
      }
    }
  };
  expect_same(MooneyRivlin({.C10 = mu / 2, .C01 = 0}, kappa), 1e-11);
  expect_same(MooneyRivlin5({.C10 = mu / 2, .C01 = 0, .C20 = 0, .C11 = 0, .C02 = 0}, kappa), 1e-11);
  expect_same(Yeoh({.C10 = mu / 2, .C20 = 0, .C30 = 0}, kappa), 1e-11);
  expect_same(Ogden({{mu, 2}}, kappa), 1e-11);
  expect_same(DemirayFung({.mu = mu, .b = 1e-9}, kappa), 1e-7);
  expect_same(ArrudaBoyce({.mu = mu, .lambda_m = 1e5}, kappa), 1e-7);
  expect_same(HolzapfelGasserOgden({.c = mu, .k1 = 0, .k2 = 1, .dispersion = 0}, {}, kappa), 1e-11);
}

/// The table makes the law that its name says, and eight at once are what each is alone.
TYPED_TEST(EveryLaw, OfTheTableEqualsTheScalarOneInEveryLane) {
  const auto law = Sample<TypeParam>::make();
  std::optional<Law> made;
  for (const LawConstants& sample : test::sample_laws(kPoisson))
    if (sample.law == Sample<TypeParam>::kName) made = make_law(sample, "tissue");
  ASSERT_TRUE(made);
  std::mt19937 random(7);
  Tensor2<Lanes> F;
  Fibres<Lanes> a;
  std::array<Matrix, kLanes> single;
  for (std::size_t f = 0; f < 2; ++f)
    for (std::size_t i = 0; i < 3; ++i) a[f][i] = Lanes::Constant(kFibres[f][i]);
  for (int lane = 0; lane < kLanes; ++lane) {
    single[at(lane)] = random_gradient(random);
    for (int i = 0; i < 9; ++i) F[at(i)][lane] = single[at(lane)](i / 3, i % 3);
  }
  const auto cof = cofactor(F);
  const Lanes J = determinant(F, cof);
  const Lanes W = made->psi(F, J, a), U = made->volumetric_energy(J), p = made->pressure(J);
  const auto P = made->piola(F, cof, J, a);
  Tensor4<Lanes> A;
  for (auto& row : A) row.fill(Lanes::Zero());
  made->add_tangent(F, cof, J, a, A);
  for (int lane = 0; lane < kLanes; ++lane) {
    const Matrix& one = single[at(lane)];
    const double size = energy(law, to_tensor(one));
    EXPECT_NEAR(W[lane] + U[lane], size, 1e-10 * size);
    const auto expected = isochoric_stress(law, to_tensor(one));
    const auto tangent = isochoric_tangent(law, one);
    const double scale = to_matrix(expected).norm();
    EXPECT_NEAR(p[lane], law.pressure(one.determinant()), 1e-10 * std::abs(p[lane]));
    for (std::size_t i = 0; i < 9; ++i) {
      EXPECT_NEAR(P[i][lane], expected[i], 1e-10 * scale);
      for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(A[i][k][lane], tangent[i][k], 1e-8 * scale);
    }
  }
}

std::string refusal(const LawConstants& constants) {
  try {
    make_law(constants, "liver");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    return error.what();
  }
  return "accepted";
}

class EveryEntry : public testing::TestWithParam<LawConstants> {};

TEST_P(EveryEntry, RefusesEachConstantOutsideItsRangeByNameValueAndRange) {
  EXPECT_EQ(refusal(GetParam()), "accepted");
  for (const LawConstant& constant : law_entry(GetParam().law).constants) {
    const std::string name(constant.name);
    const auto with = [&](double value) {
      LawConstants changed = GetParam();
      changed.at(name) = value;
      return refusal(changed);
    };
    for (const double value : {std::nan(""), HUGE_VAL, -HUGE_VAL})
      EXPECT_THAT(with(value), testing::AllOf(HasSubstr("liver"), HasSubstr(name + " = ")));
    const auto expect_refused = [&](double value) {
      std::ostringstream shown;
      shown << name << " = " << value;
      EXPECT_THAT(with(value), testing::AllOf(HasSubstr("liver"), HasSubstr(shown.str()),
                                              HasSubstr("out of range"), HasSubstr("with ")));
    };
    if (std::isfinite(constant.low)) {
      expect_refused(constant.low - 1);
      if (constant.low_open) expect_refused(constant.low);
    }
    if (std::isfinite(constant.high)) {
      expect_refused(constant.high + 1);
      if (constant.high_open) expect_refused(constant.high);
    }
    LawConstants without = GetParam();
    std::erase_if(without.values, [&](const auto& v) { return v.first == name; });
    EXPECT_THAT(refusal(without), HasSubstr(name + " is missing"));
  }
  LawConstants more = GetParam();
  more.values.emplace_back("gamma", 1.0);
  EXPECT_THAT(refusal(more), HasSubstr("no constant gamma"));
}

INSTANTIATE_TEST_SUITE_P(Table, EveryEntry, testing::ValuesIn(test::sample_laws(kPoisson)),
                         [](const auto& instance) {
                           std::string name = instance.param.law;
                           std::erase(name, '-');
                           return name;
                         });

TEST(LawTable, SamplesCoverIt) {
  const auto samples = test::sample_laws(kPoisson);
  ASSERT_EQ(samples.size(), law_table().size());
  for (std::size_t i = 0; i < samples.size(); ++i) EXPECT_EQ(samples[i].law, law_table()[i].name);
}

TEST(LawTable, RefusesConstantsThatDoNotFitTogether) {
  EXPECT_THAT(refusal({"mooney-rivlin", {{"C10", 1}, {"C01", -3}, {"poisson", 0.4}}}),
              HasSubstr("C10 + C01 = -2"));
  EXPECT_THAT(refusal({"ogden-1", {{"mu_1", -1}, {"alpha_1", 2}, {"poisson", 0.4}}}),
              HasSubstr("sum of mu_i = -1"));
  EXPECT_THAT(refusal({"ogden-1", {{"mu_1", 1}, {"alpha_1", 0}, {"poisson", 0.4}}}),
              HasSubstr("alpha_1 = 0"));
  EXPECT_THAT(refusal({"hooke", {}}), HasSubstr("use one of neo-hookean"));
}

TEST(NeoHookean, RefusesConstantsOutOfRangeByName) {
  const auto message = [](double E, double nu) -> std::string {
    try {
      NeoHookean::from_young_poisson(E, nu, "liver");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Configuration);
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message(-1, 0.4), testing::HasSubstr("young"));
  EXPECT_NE(message(std::nan(""), 0.4).find("nan"), std::string::npos);
  EXPECT_NE(message(1e3, 0.5).find("poisson (nu) = 0.5"), std::string::npos);
  EXPECT_NE(message(1e3, -0.1).find("0 <= nu < 0.5"), std::string::npos);
  EXPECT_NE(message(1e3, 0.5).find("liver"), std::string::npos);
}

TEST(FibreField, GivesUnitVectorsInThePlaneAsked) {
  FibreField field;
  field.first = {2, 0, 0};
  field.second = {5, 3, 0};
  field.angle = M_PI / 6;
  field.families = 2;
  const auto a = field.at({1, 2, 3});
  EXPECT_NEAR(a[0][0], std::sqrt(0.75), 1e-15);
  EXPECT_NEAR(a[0][1], 0.5, 1e-15);
  EXPECT_NEAR(a[1][1], -0.5, 1e-15);
  field.families = 1;
  EXPECT_EQ(field.at({})[1], field.at({})[0]);
}

TEST(FibreField, RunsAroundTheAxisOfACylinder) {
  FibreField field;
  field.kind = FibreField::Kind::Cylindrical;
  field.first = {0, 0, 3};
  field.origin = {0.1, 0, 0};
  field.angle = 0;
  // Around the axis, whichever way is meant by it, and along it at a right angle.
  EXPECT_NEAR(std::abs(field.at({0.2, 0, 0.5})[0][1]), 1, 1e-15);
  EXPECT_NEAR(std::abs(field.at({0.1, -0.3, 0.5})[0][0]), 1, 1e-15);
  field.angle = M_PI / 2;
  EXPECT_NEAR(field.at({0.2, 0, 0.5})[0][2], 1, 1e-15);
  EXPECT_NEAR(norm(field.at(field.origin)[0]), 1, 1e-15);
}

TEST(FibreField, RefusesWhatSpansNoPlane) {
  const auto with = [](auto change) {
    LawConstants law = test::sample_laws(kPoisson).back();
    change(law.fibres);
    return refusal(law);
  };
  EXPECT_THAT(with([](FibreField& f) { f.first = {}; }), HasSubstr("no length"));
  EXPECT_THAT(with([](FibreField& f) { f.second = f.first; }), HasSubstr("parallel"));
  EXPECT_THAT(with([](FibreField& f) { f.angle = 2; }), HasSubstr("angle (rad) = 2"));
  EXPECT_THAT(with([](FibreField& f) { f.families = 3; }), HasSubstr("families = 3"));
}

}  // namespace
}  // namespace palpate::fem
