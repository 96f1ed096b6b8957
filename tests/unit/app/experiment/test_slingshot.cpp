// SPDX-License-Identifier: AGPL-3.0-or-later
// The shot far from its margin; the margins are verified in tests/verification.
#include "app/experiment/slingshot.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "app/experiment/line_of_touch.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

using namespace slingshot;

TEST(Slingshot, ComesToRestWhereTheBandBalancesASoftWall) {
  constexpr double k = 40;
  const SlingshotOutcome outcome = sling({}, k, true);
  ASSERT_TRUE(outcome.decayed);
  EXPECT_LT(outcome.seconds, 60);
  ASSERT_GT(outcome.path.size(), 1000u);
  EXPECT_EQ(outcome.path.front().position, kRelease);
  EXPECT_EQ(outcome.path.front().velocity, 0);
  // kBand (anchor - x) = k (x - kCurved/2); dry friction leaves it within S over both stiffnesses,
  // and the last window still moved a little.
  const double balance = (kBand * kAnchor + k * kCurved / 2) / (k + kBand);
  EXPECT_NEAR(outcome.path.back().position, balance, 2 * kFriction / (k + kBand));
}

/// The first touch: band and friction alone act until then.
TEST(Slingshot, HitsTheWallWithTheEnergyOfTheBand) {
  const auto stored = [](double x) { return 0.5 * kBand * (kAnchor - x) * (kAnchor - x); };
  const double work = stored(kRelease) - stored(0) + kFriction * kRelease;
  const double without_damping = std::sqrt(2 * work / kMass);
  const double impact = sling({}, 40).impact;
  // Damping takes b times the way times a speed below the last one.
  const double damped = std::sqrt(2 * (work + kDamping * kRelease * without_damping) / kMass);
  EXPECT_LT(impact, without_damping);
  EXPECT_GT(impact, damped - 0.001);
}

TEST(Slingshot, OscillatesAgainstAStiffWallForEver) {
  const SlingshotOutcome outcome = sling({}, 400);
  EXPECT_FALSE(outcome.decayed);
  EXPECT_GT(outcome.amplitude, 0.3);
  EXPECT_TRUE(outcome.path.empty());  // not asked for
}

TEST(PassivityMargin, IsRefusedWhereItDoesNotLieInTheRange) {
  EXPECT_THROW(passivity_margin({}, 20, 40, 1), Error);
  EXPECT_THROW(passivity_margin({}, 300, 400, 1), Error);
}

}  // namespace
}  // namespace palpate::app
