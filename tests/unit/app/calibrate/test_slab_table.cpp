// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/slab_table.hpp"

#include <gtest/gtest.h>

#include "format/error.hpp"
#include "tests/unit/app/calibrate/pressed_layer.hpp"

namespace palpate::app {
namespace {

using samples::layer_force;

TEST(SlabTable, IsTheForceBetweenItsPoints) {
  const SlabTable table = samples::layer_table();
  EXPECT_LT(table.error(), 1e-3);
  const std::vector<double>& depths = table.settings().depths;
  for (const double stiffening : {0.3, 2.2, 3.9})
    for (const double thickness : {0.0055, 0.011, 0.05})
      for (const std::size_t d : {std::size_t{0}, depths.size() - 1}) {
        const double expected = layer_force(depths[d], stiffening, thickness);
        EXPECT_NEAR(table.at(d, stiffening, 1 / thickness).value, expected, 2e-3 * expected);
      }
}

TEST(SlabTable, HasTheDerivativesOfItsForce) {
  const SlabTable table = samples::layer_table();
  constexpr double kC = 1.7, kS = 90, kStep = 1e-4;
  const SlabTable::Force f = table.at(4, kC, kS);
  EXPECT_NEAR(f.by_stiffening,
              (table.at(4, kC + kStep, kS).value - table.at(4, kC - kStep, kS).value) / (2 * kStep),
              1e-6 * f.value);
  EXPECT_NEAR(f.by_inverse_thickness,
              (table.at(4, kC, kS + kStep).value - table.at(4, kC, kS - kStep).value) / (2 * kStep),
              1e-6 * f.value);
}

TEST(SlabTable, RefusesRangesThatAreNone) {
  const auto press = [](double, double) { return std::vector<double>(10, 1.0); };
  SlabTableSettings settings = samples::table_settings();
  settings.thickness_low = 0.002;  // the press goes to 3 mm
  EXPECT_THROW(SlabTable(settings, press), Error);
  settings = samples::table_settings();
  settings.law.high = settings.law.low;
  EXPECT_THROW(SlabTable(settings, press), Error);
}

/// The shear modulus at rest is the one that is asked for, whatever the law.
TEST(StiffeningLaw, HasTheShearModulusThatIsAskedFor) {
  for (const char* name : {"demiray-fung", "ogden-1", "veronda-westmann", "yeoh"}) {
    const StiffeningLaw law = stiffening_law(name);
    const fem::LawConstants constants = law.at(730, 0.6 * law.low + 0.4 * law.high, 0.49);
    EXPECT_NO_THROW(fem::check_law(constants, name));
    EXPECT_NEAR(fem::rest_moduli(constants).mu(), 730, 1e-6) << name;
  }
  EXPECT_THROW(stiffening_law("neo-hookean"), Error);
}

}  // namespace
}  // namespace palpate::app
