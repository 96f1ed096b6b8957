// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/laws/augmented_volume.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace palpate::fem {
namespace {

constexpr double kPenalty = 2e5;  // Pa

class AugmentedVolumeOf : public testing::TestWithParam<double> {
 protected:
  Law law = NeoHookean::from_moduli(4e3, 5e6);
  AugmentedVolume augmented{law, 5e6, kPenalty, Lanes::Constant(GetParam())};

  static Lanes all(double value) { return Lanes::Constant(value); }
  double energy_with(double s, double J) const {
    return law.volumetric_energy(all(s))[0] + GetParam() * (J - s) +
           0.5 * kPenalty * (J - s) * (J - s);
  }
  /// Minimum of a convex function of s by bisection into three parts.
  double least_energy(double J) const {
    double low = 0.5, high = 2;
    for (int i = 0; i < 200; ++i) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      (energy_with(a, J) < energy_with(b, J) ? high : low) =
          energy_with(a, J) < energy_with(b, J) ? b : a;
    }
    return energy_with(low, J);
  }
};

TEST_P(AugmentedVolumeOf, IsTheLeastEnergyOfAllDilatationsOfTheLaw) {
  for (const double J : {0.7, 0.98, 1.0, 1.01, 1.5})
    EXPECT_NEAR(augmented.volumetric_energy(all(J))[0], least_energy(J),
                1e-9 * std::max(kPenalty, std::abs(least_energy(J))));
}

TEST_P(AugmentedVolumeOf, HasItsDerivatives) {
  for (const double J : {0.7, 0.98, 1.0, 1.01, 1.5}) {
    const double h = 1e-5;
    const auto slope = [&](const auto& f) { return (f(J + h) - f(J - h)) / (2 * h); };
    EXPECT_NEAR(augmented.pressure(all(J))[0],
                slope([&](double x) { return augmented.volumetric_energy(all(x))[0]; }),
                1e-6 * kPenalty);
    EXPECT_NEAR(augmented.pressure_slope(all(J))[0],
                slope([&](double x) { return augmented.pressure(all(x))[0]; }), 1e-6 * kPenalty);
    EXPECT_LT(augmented.pressure_slope(all(J))[0], kPenalty);
  }
}

INSTANTIATE_TEST_SUITE_P(Multipliers, AugmentedVolumeOf, testing::Values(-3e4, 0.0, 2e4));

/// A multiplier that is the pressure is left alone, and energy and pressure are those of the law.
TEST(AugmentedVolume, IsTheLawWhereTheMultiplierIsThePressure) {
  const Law law = NeoHookean::from_moduli(4e3, 5e6);
  for (const double J : {0.9, 0.999, 1.002, 1.2}) {
    const Lanes dilatation = Lanes::Constant(J), p = law.pressure(dilatation);
    const AugmentedVolume augmented{law, 5e6, kPenalty, p};
    EXPECT_NEAR(augmented.law_dilatation(dilatation)[0], J, 1e-14);
    EXPECT_NEAR(augmented.pressure(dilatation)[0], p[0], 1e-10 * std::abs(p[0]));
    EXPECT_NEAR(augmented.volumetric_energy(dilatation)[0], law.volumetric_energy(dilatation)[0],
                1e-10 * law.volumetric_energy(dilatation)[0]);
  }
}

/// The dilatation under a given pressure q is where the multipliers lead: J <- the root of
/// dU_p/dJ = q, p <- q. The first step already has the pressure, the second the dilatation.
TEST(AugmentedVolume, StepsOfTheMultipliersFindTheDilatationUnderAPressure) {
  const Law law = NeoHookean::from_moduli(4e3, 5e6);
  const double q = -2e4, kappa = 5e6;
  double p = 0, J = 1;
  for (int step = 0; step < 2; ++step) {
    const AugmentedVolume augmented{law, kappa, kPenalty, Lanes::Constant(p)};
    for (int i = 0; i < 20; ++i)
      J -= (augmented.pressure(Lanes::Constant(J))[0] - q) /
           augmented.pressure_slope(Lanes::Constant(J))[0];
    p = augmented.pressure(Lanes::Constant(J))[0];
  }
  // kappa/2 (J - 1/J) = q
  EXPECT_NEAR(J, q / kappa + std::sqrt(q * q / (kappa * kappa) + 1), 1e-12);
}

}  // namespace
}  // namespace palpate::fem
