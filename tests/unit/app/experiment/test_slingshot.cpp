// SPDX-License-Identifier: AGPL-3.0-or-later
// The shot far from its margin; the margins are verified in tests/verification.
#include "app/experiment/slingshot.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "app/experiment/line_of_touch.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

constexpr SlingDevice kDevice;

TEST(Slingshot, ComesToRestWhereTheBandBalancesASoftWall) {
  constexpr double k = 40;
  const SlingshotOutcome outcome = sling({}, k, true);
  ASSERT_TRUE(outcome.decayed);
  EXPECT_LT(outcome.seconds, 60);
  ASSERT_GT(outcome.path.size(), 1000u);
  EXPECT_EQ(outcome.path.front().position, published::kRelease);
  EXPECT_EQ(outcome.path.front().velocity, 0);
  // kDevice.band (anchor - x) = k (x - slingshot::kCurved/2); dry friction leaves it within S over
  // both stiffnesses, and the last window still moved a little.
  const double balance =
      (kDevice.band * kDevice.anchor + k * slingshot::kCurved / 2) / (k + kDevice.band);
  EXPECT_NEAR(outcome.path.back().position, balance, 2 * kDevice.friction / (k + kDevice.band));
}

/// The first touch: band and friction alone act until then.
TEST(Slingshot, HitsTheWallWithTheEnergyOfTheBand) {
  const auto stored = [](double x) {
    return 0.5 * kDevice.band * (kDevice.anchor - x) * (kDevice.anchor - x);
  };
  const double work =
      stored(published::kRelease) - stored(0) + kDevice.friction * published::kRelease;
  const double without_damping = std::sqrt(2 * work / kDevice.mass);
  const double impact = sling({}, 40).impact;
  // Damping takes b times the way times a speed below the last one.
  const double damped = std::sqrt(
      2 * (work + kDevice.damping * published::kRelease * without_damping) / kDevice.mass);
  EXPECT_LT(impact, without_damping);
  EXPECT_GT(impact, damped - 0.001);
}

TEST(Slingshot, OscillatesAgainstAStiffWallForEver) {
  const SlingshotOutcome outcome = sling({}, 400);
  EXPECT_FALSE(outcome.decayed);
  EXPECT_GT(outcome.amplitude, 0.3);
  EXPECT_TRUE(outcome.path.empty());  // not asked for
}

/// With little damping nothing limits the swing: it does not pass for decayed on the far side.
TEST(Slingshot, GrowsUntilItWouldPassThroughTheCylinder) {
  SlingshotSetup setup{VirtualBody::Cylinder, 0.01, 0.3, 2000, 0};
  setup.device = {0.085, 0.0293, 0.03, 20, 0.0584};
  for (const double k : {190.0, 200.0, 220.0}) {
    const SlingshotOutcome outcome = sling(setup, k, true);
    EXPECT_FALSE(outcome.decayed) << k;
    for (const PhasePoint& p : outcome.path)
      ASSERT_LT(p.position, 0.07) << k;  // the far side is at 0.077
  }
}

TEST(PassivityMargin, IsRefusedWhereItDoesNotLieInTheRange) {
  EXPECT_THROW(passivity_margin({}, 20, 40, 1), Error);
  EXPECT_THROW(passivity_margin({}, 300, 400, 1), Error);
}

}  // namespace
}  // namespace palpate::app
