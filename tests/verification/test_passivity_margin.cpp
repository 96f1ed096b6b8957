// SPDX-License-Identifier: AGPL-3.0-or-later
// The experiment of [Mahvash & Hayward 2005, VI-B]: compared with its publication, with an energy
// balance without simulation, and between one rate and two.
#include <gtest/gtest.h>

#include <cmath>

#include "app/experiment/energy_balance.hpp"
#include "app/experiment/slingshot.hpp"

namespace palpate::app {
namespace {

constexpr double kTolerance = 1;  // N/m, of the margins

TEST(PassivityMargin, WallDecaysAt168AndOscillatesAt179AsPublished) {
  const SlingshotOutcome below = sling({}, 168);
  const SlingshotOutcome above = sling({}, 179);
  EXPECT_TRUE(below.decayed);
  EXPECT_NEAR(below.seconds, 59, 2);
  EXPECT_FALSE(above.decayed);
  EXPECT_NEAR(above.amplitude, 0.459, 0.002);
  EXPECT_NEAR(below.impact, 1, 0.01);  // "hit it with v = 1 m/s"
}

TEST(PassivityMargin, OfTheWallEqualsTheEnergyBalanceAtEveryRate) {
  struct Case {
    double rate, expected;  // Hz, N/m
  };
  for (const auto& [rate, expected] : {Case{1000, 75.6}, Case{2000, 170.6}, Case{4000, 425}}) {
    SlingshotSetup setup;
    setup.rate = rate;
    const double simulated = passivity_margin(setup, 20, 800, 0.2);
    EXPECT_NEAR(simulated, expected, kTolerance) << rate << " Hz";
    EXPECT_NEAR(simulated, bonded_margin_by_energy_balance({}, rate, 0), kTolerance)
        << rate << " Hz";
  }
  EXPECT_NEAR(passivity_margin({}, 100, 300, 0.2), 170, kTolerance);  // published
}

TEST(PassivityMargin, OfTheCylinderEqualsThatOfTheWall) {
  const SlingshotSetup one{VirtualBody::Cylinder, 0, 0.3, 2000, 0};
  EXPECT_NEAR(passivity_margin(one, 160, 180, 0.2), 170.6, kTolerance);
  // At a fixed contact point the force is within the bound k: to enforce it changes nothing.
  SlingshotSetup bounded = one;
  bounded.bounded = true;
  EXPECT_NEAR(passivity_margin(bounded, 160, 180, 0.2), 170.6, kTolerance);
}

TEST(PassivityMargin, WithoutSlipOffTheAxisIsThatOfTwoSprings) {
  // The contact point is fixed by friction: the line crosses the surface at asin(10 mm / 40 mm).
  const SlingshotSetup no_slip{VirtualBody::Cylinder, 0.01, 0.3, 2000, 0};
  const double balance = bonded_margin_by_energy_balance({}, 2000, std::asin(0.25));
  EXPECT_GT(balance, 175);  // it differs from the margin on the axis
  EXPECT_NEAR(passivity_margin(no_slip, 160, 200, 0.2), balance, kTolerance);
}

class PlayedSwings : public ::testing::TestWithParam<SlingshotSetup> {};

TEST_P(PlayedSwings, LastFromTheSameStiffnessOn) {
  const double balance = margin_by_played_swings(GetParam());
  const double simulated = passivity_margin(GetParam(), 100, 600, 0.5);
  EXPECT_NEAR(simulated, balance, 0.015 * balance);
}

INSTANTIATE_TEST_SUITE_P(
    Cylinder, PlayedSwings,
    ::testing::Values(SlingshotSetup{},  // the wall: as its closed balance
                      SlingshotSetup{VirtualBody::Cylinder, 0, 0.3, 2000, 0},
                      SlingshotSetup{VirtualBody::Cylinder, 0.01, 0.3, 2000, 0},
                      SlingshotSetup{VirtualBody::Cylinder, 0.01, 0.1, 2000, 0},
                      SlingshotSetup{VirtualBody::Cylinder, 0.01, 0, 2000, 0}));

class TwoRates : public ::testing::TestWithParam<SlingshotSetup> {};

TEST_P(TwoRates, HaveTheMarginOfOne) {
  SlingshotSetup one = GetParam();
  one.search_rate = 0;
  const double margin = passivity_margin(one, 100, 600, 0.5);
  // The margin with two rates lies within the tolerance of that with one.
  EXPECT_TRUE(sling(GetParam(), margin - kTolerance).decayed) << margin;
  EXPECT_FALSE(sling(GetParam(), margin + kTolerance).decayed) << margin;
}

INSTANTIATE_TEST_SUITE_P(
    Cylinder, TwoRates,
    ::testing::Values(SlingshotSetup{VirtualBody::Cylinder, 0, 0.3, 2000, 100},
                      SlingshotSetup{VirtualBody::Cylinder, 0, 0.3, 2000, 50},
                      SlingshotSetup{VirtualBody::Cylinder, 0.01, 0.3, 2000, 100},
                      SlingshotSetup{VirtualBody::Cylinder, 0.01, 0.1, 2000, 100},
                      SlingshotSetup{VirtualBody::Cylinder, 0.01, 0, 2000, 100}));

/// Paced by the clock, with the search in a thread: far below the margin the device comes to rest,
/// far above it oscillates as widely as in lockstep.
TEST(TwoRatesInRealTime, DecayAndOscillateAsInLockstep) {
  SlingshotSetup setup{VirtualBody::Cylinder, 0.01, 0.3, 2000, 100};
  const double lockstep = sling(setup, 400).amplitude;
  setup.real_time = true;
  EXPECT_TRUE(sling(setup, 60).decayed);
  const SlingshotOutcome oscillating = sling(setup, 400);
  EXPECT_FALSE(oscillating.decayed);
  EXPECT_NEAR(oscillating.amplitude, lockstep, 0.02 * lockstep);
}

}  // namespace
}  // namespace palpate::app
