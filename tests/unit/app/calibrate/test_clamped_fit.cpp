// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/clamped_fit.hpp"

#include <gtest/gtest.h>

#include "format/error.hpp"

namespace palpate::app {
namespace {

fem::ClampedSpecimen disc() {
  fem::ClampedSpecimen specimen;
  specimen.length = 0.008;
  specimen.diameter = 0.012;
  specimen.law = {"ogden-1", {{"mu_1", 900}, {"alpha_1", -6}, {"poisson", 0.49}}};
  return specimen;
}

/// A record that the finite elements made at stretches that are no points of the effect.
calibrate::HomogeneousTest pressed() {
  calibrate::HomogeneousTest test{"disc", calibrate::Mode::Uniaxial, {}, {}};
  for (double stretch = 0.985; stretch > 0.84; stretch -= 0.02) test.deformation.push_back(stretch);
  test.nominal = fem::clamped_stress(disc(), test.deformation);
  return test;
}

TEST(ClampedFit, FindsTheConstantsBehindClampedForces) {
  calibrate::HomogeneousSettings settings;
  settings.law = "ogden-1";
  const calibrate::HomogeneousTest test = pressed();
  const ClampedFit clamped = fit_clamped({test}, {disc()}, settings);
  EXPECT_NEAR(clamped.fit.shear_modulus, 900, 0.01 * 900);
  EXPECT_NEAR(clamped.fit.law.at("alpha_1"), -6, 0.2);
  EXPECT_GT(clamped.largest_effect.front(), 0.1);  // the plates make the disc stiffer
  for (std::size_t i = 0; i < test.nominal.size(); ++i)
    EXPECT_NEAR(clamped.fit.predicted[0][i], test.nominal[i], 0.01 * std::abs(test.nominal[i]));
  // The formula alone takes the plates for material.
  const calibrate::HomogeneousFit plain = calibrate::fit_homogeneous({test}, settings);
  EXPECT_GT(plain.shear_modulus, 1.1 * 900);
}

TEST(ClampedFit, IsThatOfTheFormulaWithoutClamps) {
  calibrate::HomogeneousSettings settings;
  settings.law = "ogden-1";
  const calibrate::HomogeneousTest test = pressed();
  const ClampedFit none = fit_clamped({test}, {std::nullopt}, settings);
  EXPECT_EQ(none.rounds, 0);
  EXPECT_EQ(none.fit.shear_modulus, calibrate::fit_homogeneous({test}, settings).shear_modulus);
}

TEST(ClampedFit, RefusesShearAndOffsets) {
  calibrate::HomogeneousSettings settings;
  settings.law = "ogden-1";
  calibrate::HomogeneousTest test = pressed();
  test.offset = true;
  EXPECT_THROW(fit_clamped({test}, {disc()}, settings), Error);
  test.offset = false;
  test.mode = calibrate::Mode::Equibiaxial;
  EXPECT_THROW(fit_clamped({test}, {disc()}, settings), Error);
}

}  // namespace
}  // namespace palpate::app
