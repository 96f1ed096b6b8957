// SPDX-License-Identifier: AGPL-3.0-or-later
#include <ceres/jet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "fem/laws/law.hpp"
#include "fem/laws/material.hpp"
#include "fitting/measurement/calibrate/incompressible_law.hpp"
#include "tests/unit/fitting/measurement/calibrate/typical_constants.hpp"

namespace palpate::calibrate {
namespace {

// Closed forms computed by hand for this project, listed with their formulas in the documentation.
TEST(IncompressibleLaw, StressesAreTheClosedForms) {
  struct Row {
    const char* law;
    double ut9, ut13, et13, ps13;
  };
  for (const Row& row : {Row{"neo-hookean", -0.334568, 0.708284, 1.030671, 0.844834},
                         Row{"mooney-rivlin", -0.342003, 0.675594, 1.172904, 0.844834},
                         Row{"yeoh", -0.333712, 0.696004, 0.980359, 0.827000},
                         Row{"demiray-fung", -0.368524, 1.405614, 9.212796, 1.967045},
                         Row{"veronda-westmann", -0.389443, 2.987940, 36.497640, 4.369419}}) {
    const auto c = typical(row.law);
    EXPECT_NEAR(law_stress(row.law, c, Mode::Uniaxial, 0.9), row.ut9, 1e-6) << row.law;
    EXPECT_NEAR(law_stress(row.law, c, Mode::Uniaxial, 1.3), row.ut13, 1e-6) << row.law;
    EXPECT_NEAR(law_stress(row.law, c, Mode::Equibiaxial, 1.3), row.et13, 2e-6) << row.law;
    EXPECT_NEAR(law_stress(row.law, c, Mode::PureShear, 1.3), row.ps13, 1e-6) << row.law;
  }
}

/// Ogden's rubber in his own constants mu_i = 2 (part of the modulus)/alpha_i.
TEST(IncompressibleLaw, OgdensRubber) {
  const std::array<double, 3> mu{0.63, 0.0012, -0.01}, alpha{1.3, 5, -2};
  std::vector<double> c;
  for (std::size_t i = 0; i < 3; ++i) {
    c.push_back(0.5 * mu[i] * alpha[i]);
    c.push_back(alpha[i]);
  }
  EXPECT_NEAR(law_stress("ogden-3", c, Mode::Uniaxial, 2), 0.60272, 1e-5);
  EXPECT_NEAR(law_stress("ogden-3", c, Mode::Equibiaxial, 2), 0.82161, 1e-5);
  EXPECT_NEAR(law_stress("ogden-3", c, Mode::PureShear, 2), 0.68562, 1e-5);
}

/// All laws have the modulus they state: stresses at small strain are 3 mu, 6 mu, 4 mu and mu times
/// the strain, whatever the law.
TEST(IncompressibleLaw, SmallStrainIsLinearElasticity) {
  for (const auto law : homogeneous_laws()) {
    const auto c = typical(law);
    const double e = 1e-5;
    const double mu = law_stress(law, c, Mode::SimpleShear, e) / e;
    EXPECT_NEAR(law_stress(law, c, Mode::Uniaxial, 1 + e) / e, 3 * mu, 2e-3 * mu) << law;
    EXPECT_NEAR(law_stress(law, c, Mode::Equibiaxial, 1 + e) / e, 6 * mu, 2e-3 * mu) << law;
    EXPECT_NEAR(law_stress(law, c, Mode::PureShear, 1 + e) / e, 4 * mu, 2e-3 * mu) << law;
    EXPECT_NEAR(law_tangent(law, c, Mode::Uniaxial, 1), 2 * mu, 1e-6 * mu) << law;
  }
  EXPECT_NEAR(law_stress("ogden-2", typical("ogden-2"), Mode::SimpleShear, 1e-5) / 1e-5, 1, 1e-6);
  EXPECT_NEAR(law_stress("arruda-boyce", {1, 3}, Mode::SimpleShear, 1e-5) / 1e-5, 1, 1e-6);
  EXPECT_NEAR(law_stress("gent", {1, 20}, Mode::SimpleShear, 1e-5) / 1e-5, 1, 1e-6);
}

/// In a chamber with smooth walls the specimen is stretched along one axis alone: the stress is the
/// slope of the energy that the solver has for this law, its volumetric part included.
TEST(IncompressibleLaw, ConfinedCompressionIsThatOfTheCompressibleLaw) {
  constexpr double kPoisson = 0.35, kStep = 1e-5;
  for (const auto law : homogeneous_laws()) {
    const auto c = typical(law);
    const IncompressibleLaw confined(law, kPoisson);
    const fem::Law solid = fem::make_law(confined.for_case(c), "law");
    const auto energy = [&](double s) {
      fem::Tensor2<fem::Lanes> F;
      for (std::size_t i = 0; i < F.size(); ++i)
        F[i] = fem::Lanes::Constant(i == 0 ? s : (i % 4 == 0 ? 1.0 : 0.0));
      const fem::Lanes J = fem::Lanes::Constant(s);
      return (solid.psi(F, J, {}) + solid.volumetric_energy(J))[0];
    };
    for (const double s : {0.7, 0.95, 1.1}) {
      const double expected = (energy(s + kStep) - energy(s - kStep)) / (2 * kStep);
      EXPECT_NEAR(confined.stress(c.data(), Mode::Confined, s), expected, 1e-6 * std::abs(expected))
          << law;
    }
  }
}

/// A pure shear and a simple shear of the same stretches store the same energy.
TEST(IncompressibleLaw, PureAndSimpleShearStoreTheSameEnergy) {
  for (const auto law : homogeneous_laws()) {
    const auto c = typical(law);
    const double gamma = 0.6;
    const double l = 0.5 * gamma + std::sqrt(1 + 0.25 * gamma * gamma);
    double simple = 0, pure = 0;
    constexpr int n = 4000;
    for (int i = 0; i < n; ++i) {
      const double t = (i + 0.5) / n;
      simple += law_stress(law, c, Mode::SimpleShear, gamma * t) * gamma / n;
      pure += law_stress(law, c, Mode::PureShear, 1 + (l - 1) * t) * (l - 1) / n;
    }
    EXPECT_NEAR(simple, pure, 1e-6 * pure) << law;
  }
}

/// A law of fem/, at unit volume, gives the same stresses through the same templates.
TEST(IncompressibleLaw, LawsOfTheSolverFitIn) {
  using Jet = ceres::Jet<double, 1>;
  const double young = 3000;
  const auto law = fem::NeoHookean::from_young_poisson(young, 0.49, "test");
  const auto energy = [&](Mode mode, const Jet& s) {
    const Jet first = mode == Mode::SimpleShear ? log(0.5 * s + sqrt(1.0 + 0.25 * s * s)) : log(s);
    fem::Tensor2<Jet> F{};
    for (std::size_t i = 0; i < 3; ++i) F[4 * i] = exp(strain_ratios(mode)[i] * first);
    return law.psi(F, Jet(1.0));
  };
  for (const Mode mode : kModes) {
    for (const double s : {0.8, 1.1, 1.7}) {
      const double ours = law_stress("neo-hookean", {young}, mode, s);
      const double loaded = mode == Mode::Equibiaxial ? 2 : 1;
      EXPECT_NEAR(energy(mode, Jet(s, 0)).v[0] / loaded, ours, 1e-9 * young);
    }
  }
}

/// Derivatives by the constants, against differences.
TEST(IncompressibleLaw, HasTheDerivativesOfItsStress) {
  for (const auto name : homogeneous_laws()) {
    const IncompressibleLaw law(name);
    const auto c = typical(name);
    ASSERT_EQ(law.constants().size(), c.size());
    for (const Mode mode : kModes) {
      const double s = rest_of(mode) + 0.3;
      std::vector<double> slope(c.size());
      const double P = law.stress(c.data(), mode, s, slope.data());
      EXPECT_NEAR(P, law.stress(c.data(), mode, s), 1e-13 * std::abs(P)) << name;
      for (std::size_t i = 0; i < c.size(); ++i) {
        auto more = c, less = c;
        const double h = 1e-5 * std::max(1.0, std::abs(c[i]));
        more[i] += h;
        less[i] -= h;
        const double difference =
            (law.stress(more.data(), mode, s) - law.stress(less.data(), mode, s)) / (2 * h);
        EXPECT_NEAR(slope[i], difference, 1e-6 * std::max(1.0, std::abs(difference))) << name;
      }
    }
  }
}

TEST(IncompressibleLaw, HasNoStressBeyondTheLimitOfGent) {
  EXPECT_TRUE(std::isnan(law_stress("gent", {1, 5}, Mode::Uniaxial, 3)));
  EXPECT_TRUE(std::isnan(law_tangent("gent", {1, 5}, Mode::Uniaxial, 3)));
}

}  // namespace
}  // namespace palpate::calibrate
