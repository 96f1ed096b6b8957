// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/passivity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace palpate {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr DeviceConstants kPen{0.081, 0.01, 0, 0, 0};

/// Largest integral of (x(t) - x_j) v(t) over that of v^2, in periods, for a command x_j of the
/// last sample that is at least `delay` periods old: what a wall of 1 N/m returns of the motion
/// that is best for it. Power iteration over motions of `kPeriods` periods in `kParts` steps each.
double returned_by_the_best_motion(double delay) {
  constexpr int kPeriods = 60, kParts = 40;
  const int n = kPeriods * kParts, late = static_cast<int>(std::lround(delay * kParts));
  std::vector<double> v(static_cast<std::size_t>(n), 1), sum(static_cast<std::size_t>(n) + 1);
  const auto up_to = [&](int i) { return sum[static_cast<std::size_t>(std::clamp(i, 0, n))]; };
  const auto sample = [&](int i) {  // the one that acts in step i
    return static_cast<int>(std::floor(static_cast<double>(i - late) / kParts)) * kParts;
  };
  double ratio = 0;
  for (int pass = 0; pass < 500; ++pass) {
    for (std::size_t i = 0; i < v.size(); ++i) sum[i + 1] = sum[i] + v[i] / kParts;
    double length = 0, work = 0;
    std::vector<double> next(v.size());
    for (int i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double lag = 0.5 * (up_to(i) + up_to(i + 1)) - up_to(sample(i));
      const int last = (i / kParts + 1) * kParts + late;  // from then on a later sample acts
      const double led = up_to(last) - 0.5 * (up_to(i) + up_to(i + 1));
      next[k] = 0.5 * (lag + led);
      work += next[k] * v[k];
      length += v[k] * v[k];
    }
    ratio = work / length;
    const double size = std::sqrt(length);
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = next[i] / size;
  }
  return ratio;
}

TEST(DampingTime, IsAttainedByALinearWallForWholeSamplesOfDelay) {
  // damping_time() includes one sample of the loop.
  for (const double delay : {0.0, 1.0}) {
    const double returned = returned_by_the_best_motion(1 + delay);
    EXPECT_LE(returned, damping_time(1, delay, 0));
    EXPECT_GE(returned, 0.985 * damping_time(1, delay, 0)) << delay;
  }
}

TEST(DampingTime, CoversEveryFractionOfASample) {
  for (const double delay : {0.025, 0.25, 0.5, 0.75, 1.25, 1.5, 2.0, 3.5}) {
    EXPECT_LE(returned_by_the_best_motion(1 + delay), damping_time(1, delay, 0)) << delay;
  }
  // "The delay plus half a period" would not do: 1.06 > 1.
  EXPECT_GT(returned_by_the_best_motion(0.5), 1.05);
}

TEST(LowestRate, IsOneAndAHalfBoundsOverTheDampingWithoutDelay) {
  EXPECT_NEAR(lowest_rate(kPen, {170, 0}), 1.5 * 170 / 0.081, 1e-9);
  EXPECT_NEAR(published_rate(0.081, 170), 2 * 170 / 0.081, 1e-9);
  EXPECT_NEAR(certifiable_stiffness(kPen, 2000, 0), 2000 * 0.081 / 1.5, 1e-12);
}

TEST(LowestRate, IsThatFromWhichOnEveryRateIsCertified) {
  for (const double delay : {0.0, 20e-6, 200e-6, 3e-4, 3.4e-4, 4e-4}) {
    DeviceConstants device = kPen;
    device.delay = delay;
    const double lowest = lowest_rate(device, {170, 0});
    ASSERT_TRUE(std::isfinite(lowest)) << delay;
    for (const double more : {1.0001, 1.1, 1.5, 3.0, 100.0})
      EXPECT_TRUE(judge_passivity(device, {170, 0}, more * lowest).certified())
          << delay << " " << more;
    EXPECT_NEAR(certifiable_stiffness(device, lowest * 1.0000001, 0), 170, 1e-3) << delay;
    EXPECT_FALSE(judge_passivity(device, {170, 0}, 0.999 * lowest).certified()) << delay;
  }
  DeviceConstants late = kPen;
  late.delay = 0.081 / 170;  // all of the damping goes into the delay
  EXPECT_EQ(lowest_rate(late, {170, 0}), kInfinity);
}

TEST(LowestRate, CountsWhatRelaxationChangesAtRest) {
  for (const double delay : {0.0, 20e-6, 2e-4}) {
    DeviceConstants device = kPen;
    device.delay = delay;
    const double elastic = lowest_rate(device, {170, 0});
    const double lowest = lowest_rate(device, {170, 30});
    EXPECT_GT(lowest, elastic);
    EXPECT_NEAR(lowest_rate(device, {170, 1e-12}), elastic, 1e-6 * elastic);
    for (const double more : {1.0001, 1.5, 30.0})
      EXPECT_TRUE(judge_passivity(device, {170, 30}, more * lowest).certified()) << delay;
    EXPECT_FALSE(judge_passivity(device, {170, 30}, 0.999 * lowest).certified()) << delay;
    EXPECT_NEAR(certifiable_stiffness(device, lowest, 30), 170, 1e-6) << delay;
  }
  // A hundredth of the time in which the tissue relaxes, and one sample: 1.5 T and 1 % of T.
  EXPECT_NEAR(damping_time(1e-3, 0, 10), 1.51e-3, 1e-15);
}

TEST(LargestPositionStep, IsThatOfAbbottAndOkamuraOnThreeAxes) {
  DeviceConstants device{1, 0.1, 0, 50e-6, 0};
  // K <= 2 f_c/Delta on one axis; the error along a diagonal is sqrt(3) times larger.
  EXPECT_NEAR(certifiable_stiffness_by_friction(device), 2 * 0.1 / 50e-6 / std::sqrt(3.0), 1e-6);
  const double step = largest_position_step(device, 500);
  device.position_resolution = step * 1.000001;
  EXPECT_FALSE(judge_passivity(device, {500, 0}, 1e6).certified());
  device.position_resolution = step * 0.999999;
  EXPECT_TRUE(judge_passivity(device, {500, 0}, 1e6).certified());
  device.force_resolution = 1e-3;  // the amplifier takes its part
  EXPECT_FALSE(judge_passivity(device, {500, 0}, 1e6).certified());
  EXPECT_LT(largest_position_step(device, 500), step);
  device.force_resolution = 1;
  EXPECT_EQ(largest_position_step(device, 500), 0);
}

TEST(PassivityVerdict, IsNeverCertifiedWithAnUnknownConstant) {
  EXPECT_TRUE(judge_passivity(kPen, {50, 0}, 1e4).certified());
  EXPECT_THAT(judge_passivity(kPen, {50, 0}, 1e4).unknown, IsEmpty());
  for (double DeviceConstants::*one :
       {&DeviceConstants::damping, &DeviceConstants::coulomb_friction, &DeviceConstants::delay,
        &DeviceConstants::position_resolution, &DeviceConstants::force_resolution}) {
    DeviceConstants device = kPen;
    device.*one = kUnknown;
    const PassivityVerdict verdict = judge_passivity(device, {50, 0}, 1e4);
    EXPECT_FALSE(verdict.certified());
    EXPECT_EQ(verdict.unknown.size(), 1u);
  }
  EXPECT_THAT(
      judge_passivity({}, {50, 0}, 1e4).unknown,
      ElementsAre("damping", "delay", "dry friction", "position resolution", "force resolution"));
  EXPECT_FALSE(judge_passivity(kPen, {kInfinity, 0}, 1e9).certified());
}

TEST(ListInWords, ReadsAsASentence) {
  EXPECT_EQ(list_in_words({}), "");
  EXPECT_EQ(list_in_words({"a"}), "a");
  EXPECT_EQ(list_in_words({"a", "b", "c"}), "a, b and c");
}

}  // namespace
}  // namespace palpate
