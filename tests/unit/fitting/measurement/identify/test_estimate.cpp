// SPDX-License-Identifier: AGPL-3.0-or-later
// Simulated devices of known constants, moved by the excitation.
#include "fitting/measurement/identify/estimate.hpp"

#include <gtest/gtest.h>

#include "tests/unit/fitting/measurement/identify/moved_device.hpp"

namespace palpate::identify {
namespace {

using samples::moved;
using samples::MovedDevice;

double mean_delay(const MovedDevice& d) {
  return d.delay + d.delay_spread / 2 + d.lateness / 2;
}

void expect_recovered(const MovedDevice& d, std::size_t axis, double tolerance) {
  const AxisEstimate e = estimate_axis(moved(d, axis), samples::kLargestDelay);
  ASSERT_EQ(e.problem, "");
  EXPECT_NEAR(e.mass.value, d.mass[axis], tolerance * d.mass[axis]);
  EXPECT_NEAR(e.damping[0].value, d.damping[axis], tolerance * d.damping[axis]);
  EXPECT_NEAR(e.friction.value, d.friction[axis], tolerance * d.friction[axis]);
  EXPECT_NEAR(e.bias.value, d.bias[axis], tolerance * (d.bias[axis] + d.friction[axis]));
  EXPECT_NEAR(e.delay.value, mean_delay(d), tolerance * mean_delay(d));
}

TEST(AxisEstimate, WithoutNoiseIsExact) {
  expect_recovered({}, 0, 1e-3);
}

TEST(AxisEstimate, RecoversTheConstantsOfOtherDevicesWithinFivePercent) {
  MovedDevice light;
  light.mass = {0.06, 0.08, 0.0845};
  light.damping = {0.15, 0.1, 0.081};
  light.friction = {0.04, 0.03, 0.01};
  light.bias = {0, 0, 0.05};
  light.resolution = 1e-5;
  light.delay = 2.7e-3;
  light.seconds = 30;
  light.jitter = 1e-4;
  for (std::size_t axis = 0; axis < 3; ++axis) expect_recovered(light, axis, 0.05);

  MovedDevice heavy;
  heavy.mass = {0.25, 0.25, 0.3};
  heavy.damping = {0.8, 0.8, 1.2};
  heavy.friction = {0.1, 0.1, 0.15};
  heavy.delay = 7.3e-3;
  heavy.resolution = 2e-6;
  heavy.max_force = 4;
  for (std::size_t axis = 0; axis < 3; ++axis) expect_recovered(heavy, axis, 0.05);
}

/// A bus that is shared: the delay of each command varies by as much as a period, and the age of
/// each position a little. The longer the measurement, the less they disturb.
TEST(AxisEstimate, RecoversTheConstantsOfADeviceWhoseDelayVaries) {
  for (const double spread : {3e-4, 1e-3}) {
    MovedDevice d;
    d.seconds = 60;
    d.resolution = 1e-5;
    d.delay = 2e-3;
    d.delay_spread = spread;
    expect_recovered(d, 0, 0.05);
    d.lateness = 1e-4;
    expect_recovered(d, 0, 0.05);
  }
}

/// What the certificate takes of this device is on the safe side, as often as the deviations
/// promise. `delay_of`: the bound of its delay.
template <class Bound>
void expect_safe_bounds(MovedDevice d, const Bound& delay_of) {
  int damping = 0, friction = 0, delay = 0;
  constexpr unsigned kRuns = 20;
  d.noise = 0.005;
  d.resolution = 1e-5;
  for (d.seed = 1; d.seed <= kRuns; ++d.seed) {
    const AxisEstimate e = estimate_axis(moved(d, 0), samples::kLargestDelay);
    damping += e.damping[0].low() < d.damping[0] ? 1 : 0;
    friction += e.friction.low() < d.friction[0] ? 1 : 0;
    delay += delay_of(e) > d.delay + d.delay_spread + d.lateness ? 1 : 0;
  }
  EXPECT_GE(damping, 18);
  EXPECT_GE(friction, 18);
  EXPECT_GE(delay, 18);
}

TEST(AxisEstimate, BoundsAreOnTheSafeSideInRepeatedMeasurements) {
  MovedDevice d;
  d.delay = 1.6e-3;
  expect_safe_bounds(d, [](const AxisEstimate& e) { return e.delay.high(); });
}

TEST(AxisEstimate, BoundsAreOnTheSafeSideWhereTheDelayVaries) {
  MovedDevice d;
  d.delay_spread = 5e-4;
  d.lateness = 3e-4;
  expect_safe_bounds(d, [](const AxisEstimate& e) { return delay_bound(e.delay, e.spread, 0); });
}

TEST(AxisEstimate, SaysWhatIsWrongWithMotionThatTellsNothing) {
  MovedDevice stuck;
  stuck.friction = {2, 2, 2};
  EXPECT_NE(estimate_axis(moved(stuck, 0), samples::kLargestDelay).problem.find("moves too little"),
            std::string::npos);
  MovedDevice brief;
  brief.seconds = 2;
  EXPECT_NE(estimate_axis(moved(brief, 0), samples::kLargestDelay).problem, "");
  MotionRecord reversed = moved({}, 0);
  for (Vec3& x : reversed.position) x = -x;
  EXPECT_NE(estimate_axis(reversed, samples::kLargestDelay).problem.find("does not follow"),
            std::string::npos);
  EXPECT_NE(estimate_axis({}, samples::kLargestDelay).problem, "");
}

TEST(PositionStep, IsThatOfTheGridOrSmall) {
  MovedDevice d;
  EXPECT_LT(position_step(moved(d, 0)), 4e-6);
  for (const double step : {1e-5, 3e-5, 1e-4}) {
    d.resolution = step;
    const double found = position_step(moved(d, 0));
    EXPECT_GE(found, 0.95 * step);
    EXPECT_LE(found, 1.15 * step);
  }
}

}  // namespace
}  // namespace palpate::identify
