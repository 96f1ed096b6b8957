// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/experiment/sling_device.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "app/experiment/energy_balance.hpp"
#include "app/experiment/line_of_touch.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

/// Without losses the band's energy becomes kinetic.
TEST(ImpactSpeed, WithoutLossesIsThatOfTheEnergyOfTheBand) {
  const SlingDevice device{0.2, 0, 0, 15, 0.05};
  const double way = device.anchor - published::kRelease;
  const double stored = 0.5 * device.band * (way * way - device.anchor * device.anchor);
  EXPECT_NEAR(impact_speed(device), std::sqrt(2 * stored / device.mass), 1e-5);
}

TEST(ImpactSpeed, IsZeroWhereFrictionHoldsTheBand) {
  EXPECT_EQ(impact_speed({0.1, 0.1, 5, 20, 0.0584}), 0);
}

/// The constants that the program uses are those that the publication determines.
TEST(FittedDevice, IsTheDefaultOne) {
  const SlingDevice used;
  const SlingDevice fitted = fitted_device(used.band, used.friction);
  EXPECT_NEAR(fitted.mass, used.mass, 0.005 * used.mass);
  EXPECT_NEAR(fitted.damping, used.damping, 0.01 * used.damping);
  EXPECT_NEAR(fitted.anchor, used.anchor, 1e-4);
}

/// For another band and friction: impact, force at rest and passivity margin are the published
/// ones.
TEST(FittedDevice, AgreesWithWhatIsPublished) {
  const SlingDevice device = fitted_device(40, 0.02);
  EXPECT_NEAR(impact_speed(device), published::kImpact, 1e-4);
  EXPECT_NEAR(bonded_margin_by_energy_balance(device, published::kRate, 0), published::kMargin,
              0.1);
  // At rest band and wall balance: by bisection of their difference.
  double low = 0, high = device.anchor;
  for (int i = 0; i < 60; ++i) {
    const double x = (low + high) / 2;
    const double wall = slingshot::wall_force(published::kMargin, x);
    (wall < device.band * (device.anchor - x) ? low : high) = x;
  }
  EXPECT_NEAR(slingshot::wall_force(published::kMargin, low), published::kRestForce, 1e-6);
}

TEST(FittedDevice, IsRefusedWhereDryFrictionAloneIsEnough) {
  EXPECT_THROW(fitted_device(20, 0.2), Error);
}

}  // namespace
}  // namespace palpate::app
