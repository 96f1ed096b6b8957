// SPDX-License-Identifier: AGPL-3.0-or-later
// The energies behind the names of the table are those of the solver's laws.
#include <gtest/gtest.h>

#include "fem/laws/energy_of_law.hpp"
#include "fem/laws/law.hpp"
#include "tests/unit/fem/laws/law_samples.hpp"

namespace palpate::fem {
namespace {

std::vector<double> in_order(const LawConstants& sample) {
  std::vector<double> values;
  for (const LawConstant& constant : law_entry(sample.law).constants)
    values.push_back(sample.at(constant.name));
  return values;
}

PrincipalStresses<double> stresses_of(const LawConstants& sample,
                                      const std::array<double, 3>& strain) {
  const std::vector<double> values = in_order(sample);
  return with_energy(sample.law, std::span<const double>(values),
                     [&](const auto& energy) { return incompressible_stresses(energy, strain); });
}

constexpr std::array<double, 3> kStrain{0.3, -0.1, -0.2};

TEST(EnergyOfLaw, HasThePrincipalStressesOfTheSolverButForAPressure) {
  for (const LawConstants& sample : test::sample_laws(kPoisson)) {
    if (!has_isotropic_energy(sample.law)) continue;
    const Law law = make_law(sample, "tissue");
    Tensor2<Lanes> F;
    F.fill(Lanes::Zero());
    for (std::size_t i = 0; i < 3; ++i) F[4 * i] = Lanes::Constant(std::exp(kStrain[i]));
    const auto P = law.piola(F, cofactor(F), Lanes::Constant(1.0), {});
    const auto tau = stresses_of(sample, kStrain).tau;
    for (const std::size_t i : {0U, 1U}) {
      const double solver = P[4 * i][0] * F[4 * i][0] - P[8][0] * F[8][0];
      EXPECT_NEAR(tau[i] - tau[2], solver, 1e-10 * std::abs(solver)) << sample.law;
    }
  }
}

/// W1 and W2 by differences of W. Ogden's energies are functions of the stretches.
TEST(EnergyOfLaw, SlopesByTheInvariantsAreThoseOfItsValue) {
  constexpr double kX = 0.4, kY = 0.3, kStep = 1e-5;
  std::size_t compared = 0;
  for (const LawConstants& sample : test::sample_laws(kPoisson)) {
    if (!has_isotropic_energy(sample.law) || sample.law.starts_with("ogden")) continue;
    const std::vector<double> values = in_order(sample);
    compared += with_energy(sample.law, std::span<const double>(values), [&](const auto& energy) {
      if constexpr (requires { energy.value(kX, kY); }) {
        const auto W = energy.slopes(kX, kY);
        const double by_x = energy.value(kX + kStep, kY) - energy.value(kX - kStep, kY);
        const double by_y = energy.value(kX, kY + kStep) - energy.value(kX, kY - kStep);
        EXPECT_NEAR(by_x / (2 * kStep), W.W1, 1e-7 * W.W1) << sample.law;
        EXPECT_NEAR(by_y / (2 * kStep), W.W2, 1e-7 * W.W1) << sample.law;
        return std::size_t{1};
      }
      return std::size_t{0};
    });
  }
  EXPECT_EQ(compared, 8U);
}

TEST(EnergyOfLaw, SlopesAreTheDerivativesOfTheStresses) {
  for (const LawConstants& sample : test::sample_laws(kPoisson)) {
    if (!has_isotropic_energy(sample.law)) continue;
    const auto s = stresses_of(sample, kStrain);
    constexpr double h = 1e-5;
    for (const std::size_t j : {0U, 1U}) {  // by e_j at constant volume
      auto more = kStrain, less = kStrain;
      more[j] += h;
      more[2] -= h;
      less[j] -= h;
      less[2] += h;
      const auto high = stresses_of(sample, more).tau, low = stresses_of(sample, less).tau;
      for (const std::size_t i : {0U, 1U}) {
        const double difference = (high[i] - high[2] - low[i] + low[2]) / (2 * h);
        const double slope = s.slope[i][j] - s.slope[i][2] - s.slope[2][j] + s.slope[2][2];
        EXPECT_NEAR(slope, difference, 1e-6 * std::abs(s.slope[0][0])) << sample.law;
      }
    }
  }
}

TEST(EnergyOfLaw, IsThatOfEveryLawButTwo) {
  std::vector<std::string_view> others;
  for (const LawEntry& entry : law_table())
    if (!has_isotropic_energy(entry.name)) others.push_back(entry.name);
  EXPECT_EQ(others,
            (std::vector<std::string_view>{"saint-venant-kirchhoff", "holzapfel-gasser-ogden"}));
}

}  // namespace
}  // namespace palpate::fem
