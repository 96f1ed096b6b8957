// SPDX-License-Identifier: AGPL-3.0-or-later
// Every law against the closed forms of the incompressible solid in homogeneous deformations.
#include <gtest/gtest.h>

#include "fem/laws/law.hpp"
#include "tests/unit/fem/laws/law_samples.hpp"

namespace palpate::fem {
namespace {

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
TEST(ClosedFormOf, Gent) {
  // W1 = mu J_m/(2 (J_m - (I1 - 3))).
  const auto slopes = [](double I1, double) { return std::pair{0.5 * 5 / (5 - (I1 - 3)), 0.0}; };
  expect_closed_forms(Gent({.mu = 1, .J_m = 5}, 0), closed_forms(slopes, 1.5), 1.5);
}
TEST(ClosedFormOf, GentHasNoValueBeyondItsLimit) {
  const Gent law({.mu = 1, .J_m = 5}, 0);
  const Matrix F = Eigen::Vector3d(3, 1 / std::sqrt(3.0), 1 / std::sqrt(3.0)).asDiagonal();
  EXPECT_TRUE(std::isnan(law.psi(to_tensor(F), 1.0)));
  EXPECT_TRUE(std::isnan(stress(law, to_tensor(F))[0]));
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
  // and a constant axial stretch: tau_1 - tau_3 = c (l1^2 - l3^2) + 4 k1 E exp(k2 E^2) l1^2 cos^2.
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
  check(Gent({.mu = 1, .J_m = 5}, 0), 2.5 / (5 - x), 0);
  check(VerondaWestmann({.C1 = 0.25, .C2 = 4}, 0), std::exp(4 * x), -0.5);
  // In principal stretches, as functions of the invariants: alpha = 2 is I1, alpha = -2 is I2.
  check(Ogden({{0.8, 2}, {0.2, -2}}, 0), 0.4, 0.1);
}

}  // namespace
}  // namespace palpate::fem
