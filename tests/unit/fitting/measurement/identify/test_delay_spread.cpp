// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/identify/delay_spread.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fitting/measurement/identify/estimate.hpp"
#include "tests/unit/fitting/measurement/identify/moved_device.hpp"

namespace palpate::identify {
namespace {

using samples::MovedDevice;

AxisEstimate estimate(const MovedDevice& d) {
  AxisEstimate e = estimate_axis(samples::moved(d, 0), samples::kLargestDelay);
  EXPECT_EQ(e.problem, "");
  return e;
}

/// What (C11) of docs/theory-certificate.md requires of a device, s.
double required(const MovedDevice& d) {
  return d.delay + d.delay_spread + d.lateness + 0.75 * d.lateness;
}

TEST(DelaySpread, IsNoneWhereTheDelayIsConstant) {
  MovedDevice d;
  d.delay = 2e-3;
  const AxisEstimate e = estimate(d);
  EXPECT_GT(e.spread.dated, 40U);
  EXPECT_NEAR(e.spread.latest.value, 2e-3, 1e-5);
  EXPECT_LT(e.spread.lateness_range, 1e-5);
  EXPECT_NEAR(delay_bound(e.delay, e.spread, 0), 2e-3, 3e-5);
}

TEST(DelaySpread, OfCommandsIsDatedByTheirJumps) {
  for (const double resolution : {0.0, 1e-5})
    for (const double spread : {3e-4, 1e-3, 2e-3}) {
      MovedDevice d;
      d.delay = 2e-3;
      d.delay_spread = spread;
      d.resolution = resolution;
      const AxisEstimate e = estimate(d);
      EXPECT_NEAR(e.spread.latest.value, d.delay + spread, 0.05 * (d.delay + spread)) << spread;
      const double bound = delay_bound(e.delay, e.spread, 0);
      EXPECT_GT(bound, required(d)) << spread;
      EXPECT_LT(bound, 1.15 * required(d) + 20 * resolution) << spread;
      EXPECT_GT(bound, e.delay.high());  // what a constant would be taken for
    }
}

/// A position that is old when it is reported delays its command, and no other.
TEST(DelaySpread, OfPositionsShowsInTheirDistanceFromASmoothMotion) {
  for (const double lateness : {3e-4, 6e-4}) {
    MovedDevice d;
    d.delay = 2e-3;
    d.lateness = lateness;
    d.resolution = 2e-6;
    const AxisEstimate e = estimate(d);
    EXPECT_GT(e.spread.lateness, lateness / 2);
    EXPECT_LT(e.spread.lateness, lateness);
    EXPECT_GT(e.spread.lateness_range, lateness);
    EXPECT_GT(delay_bound(e.delay, e.spread, 0), required(d));
    EXPECT_LT(delay_bound(e.delay, e.spread, 0), 1.7 * required(d));
  }
}

TEST(DelaySpread, CountsWhatLengthensThePeriod) {
  const DelaySpread spread{{2e-3, 1e-4}, 40, 3e-4, 5e-4};
  EXPECT_NEAR(delay_bound({1.8e-3, 1e-5}, spread, 4e-4), 2.25e-3 + 3e-4 + 0.75 * 9e-4, 1e-12);
  EXPECT_NEAR(delay_bound({2.4e-3, 0}, spread, 0), 2.4e-3 + 3e-4 + 0.75 * 5e-4, 1e-12);
}

TEST(DelaySpread, IsNotKnownWithoutJumps) {
  MotionRecord record = samples::moved({}, 0);
  record.jump.clear();
  const AxisEstimate e = estimate_axis(record, samples::kLargestDelay);
  EXPECT_EQ(e.problem, "");
  EXPECT_TRUE(std::isnan(delay_bound(e.delay, e.spread, 0)));
}

}  // namespace
}  // namespace palpate::identify
