// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/saturation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fitting/measurement/records/batch.hpp"
#include "fitting/measurement/records/press.hpp"
#include "tests/unit/fitting/measurement/records/bench.hpp"

namespace palpate::measured {
namespace {

/// What a load cell shows that reads no more than a limit, in steps of its resolution.
std::vector<double> as_read(std::vector<double> force, double limit, double step = 0) {
  for (double& f : force) {
    if (step > 0) f = step * std::round(f / step);
    f = std::min(f, limit);
  }
  return force;
}

/// Depth at which a sphere meets a force.
double depth_of(const Bench& bench, double force) {
  double low = 0, high = bench.depth;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (sneddon_force(middle, bench.radius, bench.modulus) < force ? low : high) = middle;
  }
  return low;
}

/// The curve of a press that goes beyond the range of the load cell is that of a press that does
/// not, as far as it goes.
TEST(Saturation, EndsTheCurveWhereTheLoadCellReachesItsLimit) {
  const Bench bench;
  PressRecord record = press_on(bench, 1);
  const double largest = sneddon_force(bench.depth, bench.radius, bench.modulus);
  const double limit = 0.6 * largest + bench.offset, depth = depth_of(bench, 0.6 * largest);
  record.force = as_read(record.force, limit);
  for (const double sign : {1.0, -1.0}) {
    PressRecord signed_record = record;
    for (double& f : signed_record.force) f *= sign;
    EXPECT_EQ(orient(signed_record).force, sign);
    const PressCurve curve = analyse_press(signed_record, {});
    ASSERT_TRUE(curve.saturation);
    EXPECT_DOUBLE_EQ(curve.saturation->reading, limit);
    EXPECT_NEAR(curve.saturation->from, (bench.contact + depth) / bench.speed, 0.1);
    EXPECT_NEAR(curve.saturation->travel, bench.depth - depth, 0.1e-3);
    EXPECT_NEAR(curve.loading.back().depth, depth, 0.1e-3);
    EXPECT_LT(curve.loading.back().depth, depth + 0.02e-3);
    for (const DepthForce& sample : curve.loading)
      EXPECT_NEAR(sample.force, sneddon_force(sample.depth, bench.radius, bench.modulus),
                  5 * bench.noise + 0.01 * largest);
    EXPECT_TRUE(std::isnan(curve.work_returned)) << "of a loading branch that lost its end";
  }
}

/// Noise lifts some samples to the limit before the force is there: from the first on they are cut
/// off on one side, and their mean is too low.
TEST(Saturation, BeginsWithTheNoiseAtTheLimit) {
  Bench bench;
  bench.noise = 0.02;
  bench.rate = 200;
  PressRecord record = press_on(bench, 3);
  const double largest = sneddon_force(bench.depth, bench.radius, bench.modulus);
  const double limit = 0.7 * largest + bench.offset;
  record.force = as_read(record.force, limit);
  const PressCurve curve = analyse_press(record, {});
  ASSERT_TRUE(curve.saturation);
  const double half = 2 * bench.noise;
  EXPECT_LT(curve.loading.back().depth, depth_of(bench, 0.7 * largest));
  EXPECT_GT(curve.loading.back().depth, depth_of(bench, 0.7 * largest - 2 * half));
}

TEST(Saturation, IsNotWhatAGoodRecordShows) {
  Bench slow, held, quiet;
  held.hold = 3;
  quiet.noise = 0;
  for (const Bench& bench : {slow, held, quiet}) {
    const PressRecord record = press_on(bench, 2);
    EXPECT_FALSE(analyse_press(record, {}).saturation);
    const double largest = *std::ranges::max_element(record.force);
    // Resolutions of a hundredth and of a tenth of the force, and a limit that is just met.
    for (const double steps : {100.0, 10.0}) {
      const Cycle cycle = cycles_of(record.displacement).front();
      const std::vector<double> read = as_read(record.force, largest, largest / steps);
      EXPECT_FALSE(saturation_of(read, record.displacement, cycle)) << steps << " steps";
    }
  }
}

/// A cell that reads no negative force rests at zero, and a tool that slows down before it turns
/// has many samples at its deepest point.
TEST(Saturation, IsNoRestAtZeroAndNoSlowTool) {
  std::vector<double> x, f;
  for (int i = 0; i < 400; ++i) {
    const double phase = M_PI * i / 399;
    x.push_back(0.004 * std::sin(phase));
    f.push_back(0.02 * std::round(50 * std::max(0.0, 4e3 * std::pow(x.back() - 0.001, 1.0))));
  }
  EXPECT_FALSE(saturation_of(f, x, cycles_of(x).front()));
  const std::vector<double> nothing(x.size(), 0.0);
  EXPECT_FALSE(saturation_of(nothing, x, cycles_of(x).front()));
}

/// Ten samples a press, of which the last three read the same.
TEST(Saturation, IsSeenInCoarseRecords) {
  std::vector<double> x, f;
  for (int i = 0; i < 10; ++i) {
    x.push_back(3e-4 * i);
    f.push_back(0.02 * std::pow(i, 1.7));
  }
  Cycle cycle;
  cycle.peak = 9;
  cycle.end = cycle.loading_end = 10;
  EXPECT_FALSE(saturation_of(f, x, cycle));
  f[8] = f[9] = f[7];
  const auto found = saturation_of(f, x, cycle);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->first, 7U);
  EXPECT_EQ(found->last, 9U);
  EXPECT_NEAR(found->travel, 6e-4, 1e-12);
}

/// A limit that a later press of the record passes is none.
TEST(Saturation, IsNoPlateauThatIsPassedLater) {
  const Bench bench;
  PressRecord record = press_on(bench, 1);
  const double limit = 0.6 * *std::ranges::max_element(record.force);
  record.force = as_read(record.force, limit);
  EXPECT_TRUE(
      saturation_of(record.force, record.displacement, cycles_of(record.displacement).front()));
  record.force.back() = 1.1 * limit;
  EXPECT_FALSE(
      saturation_of(record.force, record.displacement, cycles_of(record.displacement).front()));
}

/// A sensor whose third axis is at its limit: the force along an inclined normal is not constant.
TEST(Saturation, IsFoundInAChannelOfTheSensor) {
  const Vec3 n{0.6, 0, 0.8};
  const Bench bench;
  const PressRecord press = press_on(bench, 5);
  const double limit = 0.5 * 0.8 * *std::ranges::max_element(press.force);
  BatchLog log;
  log.name = "robot.csv";
  for (std::size_t i = 0; i < press.time.size(); ++i) {
    log.site.push_back(1);
    log.time.push_back(press.time[i]);
    log.outward.push_back(n);
    log.position.push_back(-press.displacement[i] * n);
    const Vec3 force = -press.force[i] * n;
    log.readings.push_back({-force[0], -force[1], std::min(-force[2], limit)});
    log.force.push_back(-log.readings.back());
  }
  const Batch batch = split_batch(log, {});
  ASSERT_EQ(batch.sites.size(), 1U);
  const PressCurve& curve = batch.sites[0].press;
  ASSERT_TRUE(curve.saturation);
  EXPECT_DOUBLE_EQ(curve.saturation->reading, limit);
  EXPECT_LT(curve.loading.back().force, limit / 0.8);
}

}  // namespace
}  // namespace palpate::measured
