// SPDX-License-Identifier: AGPL-3.0-or-later
// The force loop with devices that behave, and with devices that do not.
#include "runtime/force_loop.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "runtime/palpate.h"
#include "runtime/realtime.hpp"
#include "tests/unit/runtime/loop_rig.hpp"

namespace palpate::test {
namespace {

using runtime::DeviceReading;
using runtime::DeviceStatus;

TEST(ForceLoop, CommandsTheForceOfTheBodyAndRecordsEveryStep) {
  LoopRig rig;
  for (int i = 0; i < 200; ++i) EXPECT_TRUE(rig.loop.tick(runtime::monotonic_ns()));
  const auto steps = drain(rig.queue);
  ASSERT_EQ(steps.size(), 200U);
  EXPECT_EQ(rig.device.commanded.size(), 200U);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_EQ(steps[i].force, rig.device.commanded[i]);
    const double z = steps[i].depth;
    EXPECT_NEAR(steps[i].force[2], z > 0 ? 100 * 170 * z * z : 0, 1e-7);
    EXPECT_GE(steps[i].time_ns, i > 0 ? steps[i - 1].time_ns : 0);
  }
  EXPECT_GT(steps.back().force[2], 0.1);
  EXPECT_EQ(rig.loop.counts().steps, 200U);
  EXPECT_EQ(rig.loop.counts().compute.count(), 200U);
}

TEST(ForceLoop, UnpluggedInTheLoopItEndsAndKeepsWhatWasRecorded) {
  LoopRig rig;
  rig.device.status_of_read = [](int step) {
    return step < 120 ? DeviceStatus::Good : DeviceStatus::Lost;
  };
  int ticks = 0;
  while (rig.loop.tick(runtime::monotonic_ns())) ++ticks;
  EXPECT_EQ(ticks, 120);
  const auto steps = drain(rig.queue);
  ASSERT_EQ(steps.size(), 121U);
  EXPECT_GT(steps[119].force[2], 0.05);
  EXPECT_TRUE(steps[120].status & PALPATE_LOOP_DEVICE_LOST);
  EXPECT_EQ(norm(steps[120].force), 0);
  EXPECT_TRUE(rig.loop.counts().lost);
  EXPECT_EQ(norm(rig.state.contact.observation().force), 0);
}

TEST(ForceLoop, LosingTheDeviceAtTheCommandEndsItToo) {
  LoopRig rig;
  rig.device.status_of_command = [](int step) {
    return step < 7 ? DeviceStatus::Good : DeviceStatus::Lost;
  };
  int ticks = 0;
  while (rig.loop.tick(runtime::monotonic_ns())) ++ticks;
  EXPECT_EQ(ticks, 7);
}

TEST(ForceLoop, CountsSaturationAndStaleSamplesAndGoesOn) {
  LoopRig rig;
  rig.device.status_of_command = [](int step) {
    return step % 10 == 0 ? DeviceStatus::Saturated : DeviceStatus::Good;
  };
  rig.device.status_of_read = [](int step) {
    return step % 25 == 0 ? DeviceStatus::Late : DeviceStatus::Good;
  };
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(rig.loop.tick(runtime::monotonic_ns()));
  EXPECT_EQ(rig.loop.counts().saturated, 10U);
  EXPECT_EQ(rig.loop.counts().stale, 4U);
  const auto steps = drain(rig.queue);
  EXPECT_TRUE(steps[50].status & PALPATE_LOOP_SATURATED);
  EXPECT_TRUE(steps[50].status & PALPATE_LOOP_STALE);
  EXPECT_FALSE(steps[51].status & PALPATE_LOOP_SATURATED);
}

TEST(ForceLoop, APositionThatIsNoNumberGivesNoForceAndIsSurvived) {
  LoopRig rig;
  rig.device.place = [](int step) {
    DeviceReading reading = pressing(step);
    if (step == 60) reading.position[1] = std::numeric_limits<double>::quiet_NaN();
    return reading;
  };
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(rig.loop.tick(runtime::monotonic_ns()));
  EXPECT_GT(rig.device.commanded[59][2], 0.005);
  EXPECT_EQ(norm(rig.device.commanded[60]), 0);
  for (const Vec3& f : rig.device.commanded) EXPECT_TRUE(std::isfinite(norm(f)));
}

TEST(ForceLoop, AFullQueueDropsRecordsNotSteps) {
  LoopRig rig(kPatient, 50);
  for (int i = 0; i < 80; ++i) EXPECT_TRUE(rig.loop.tick(runtime::monotonic_ns()));
  EXPECT_EQ(rig.device.commanded.size(), 80U);
  EXPECT_EQ(rig.loop.counts().unrecorded, 30U);
  EXPECT_EQ(drain(rig.queue).size(), 50U);
}

TEST(ForceLoop, SafetyStandsBetweenTheBodyAndTheDevice) {
  LoopRig rig({0, 0.05, 1000, 1e6});
  for (int i = 0; i < 200; ++i) rig.loop.tick(runtime::monotonic_ns());
  EXPECT_NEAR(norm(rig.device.commanded.back()), 0.05, 1e-12);
  EXPECT_GT(rig.loop.counts().clamped, 50U);
  EXPECT_GT(norm(rig.state.contact.observation().force), 0.1);
}

}  // namespace
}  // namespace palpate::test
