// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "fitting/measurement/relaxation/before_relaxing.hpp"
#include "format/error.hpp"

namespace palpate::measured {
namespace {

constexpr double kStiffness = 200, kFraction = 0.55, kTime = 0.4;  // N/m, 1, s
constexpr double kPause = 1.5;                                     // s

/// Linear tissue with one relaxation time, pressed at a constant speed, f' = k v - g (k v t -
/// m)/tau in closed form: f = k v ((1 - g) t + g tau (1 - exp(-t/tau))).
double ramp_force(double speed, double t) {
  return kStiffness * speed *
         ((1 - kFraction) * t + kFraction * kTime * (1 - std::exp(-t / kTime)));
}

PressCurve ramp(double speed, int samples = 40) {
  PressCurve press;
  press.rate = speed;
  for (int i = 0; i <= samples; ++i) {
    const double depth = 0.004 * i / samples, t = depth / speed;
    press.loading.push_back({depth, ramp_force(speed, t), t});
  }
  return press;
}

const RelaxationSeries kSeries{{kFraction, kTime}};

/// Presses of any speed become one curve, that of the tissue at once.
TEST(BeforeRelaxing, APressOfAnySpeedGivesTheInstantaneousCurve) {
  for (const double speed : {0.001, 0.01, 0.1}) {
    const PressCurve press = before_relaxing(ramp(speed), kSeries, "ramp");
    for (const DepthForce& sample : press.loading)
      EXPECT_NEAR(sample.force, kStiffness * sample.depth, 1e-9) << speed;
  }
  EXPECT_LT(ramp(0.001).loading.back().force, 0.6 * kStiffness * 0.004);
}

/// After a pause the force starts lower; the branch lacks the samples of the pause, not its time.
/// Two ramps with the pause between them superpose: each holds its depth, the second from later on.
TEST(BeforeRelaxing, APauseCountsWithItsLength) {
  const double speed = 0.01, half = 0.2;  // m/s, s
  const auto held = [&](double t) {       // a ramp of `half` s, then a hold
    return ramp_force(speed, t) - (t > half ? ramp_force(speed, t - half) : 0);
  };
  PressCurve press;
  press.rate = speed;
  for (int i = 0; i <= 20; ++i) {
    const double t = half * i / 20;
    press.loading.push_back({speed * t, held(t), t});
  }
  for (int i = 1; i <= 20; ++i) {
    const double t = half + kPause + half * i / 20;
    press.loading.push_back({speed * (half + half * i / 20), held(t) + held(t - half - kPause), t});
  }
  for (const DepthForce& sample : before_relaxing(press, kSeries, "pause").loading)
    EXPECT_NEAR(sample.force, kStiffness * sample.depth, 1e-9);
}

TEST(BeforeRelaxing, APressWithoutTimeIsRefused) {
  PressCurve press = ramp(0.01);
  press.rate = kUnknown;
  EXPECT_THROW(before_relaxing(press, kSeries, "press.csv"), Error);
}

}  // namespace
}  // namespace palpate::measured
