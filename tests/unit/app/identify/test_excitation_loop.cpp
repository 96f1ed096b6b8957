// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/identify/excitation_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "fitting/measurement/identify/estimate.hpp"
#include "runtime/devices/device_virtual.hpp"
#include "tests/unit/runtime/scripted_device.hpp"

namespace palpate::app {
namespace {

using runtime::DeviceReading;
using runtime::DeviceStatus;

constexpr runtime::SimulatedDeviceSettings kFree{
    .mass = 0.0845, .damping = 0.081, .coulomb_friction = 0.01};

ExcitationLoopSettings settings(double seconds) {
  ExcitationLoopSettings s;
  s.excitation = {{1, 0, 0}, 1, 0.02, seconds};
  s.safety.max_force = 1;
  s.safety.max_speed = 0.7;
  s.counted_time = true;
  return s;
}

/// Runs the loop without a clock.
ExcitationEnd run(ExcitationLoop& loop) {
  for (int i = 0; i < 100000 && loop.tick(0); ++i) {
  }
  return loop.end();
}

/// The simulated device as `palpate identify` sees it: one sample of delay.
TEST(ExcitationLoop, RecordsWhatIdentifiesTheDevice) {
  runtime::VirtualDevice device(kFree, 1000, [](double) { return runtime::HandTarget{}; });
  device.open();
  ExcitationLoop loop(device, settings(15));
  EXPECT_EQ(run(loop), ExcitationEnd::Done);
  EXPECT_EQ(loop.record().time.size(), 15000U);
  const identify::AxisEstimate e = identify::estimate_axis(loop.record(), 0.03);
  ASSERT_EQ(e.problem, "");
  EXPECT_NEAR(e.mass.value, kFree.mass, 0.01 * kFree.mass);
  EXPECT_NEAR(e.damping[0].value, kFree.damping, 0.05 * kFree.damping);
  EXPECT_NEAR(e.friction.value, kFree.coulomb_friction, 0.05 * kFree.coulomb_friction);
  EXPECT_NEAR(e.delay.value, 1e-3, 5e-5);
  EXPECT_GT(e.spread.dated, 40U);
  EXPECT_NEAR(identify::delay_bound(e.delay, e.spread, 0), 1e-3, 5e-5);
}

/// The record is in the frame whose first axis is the direction; the device is moved in its own.
TEST(ExcitationLoop, MovesAlongADiagonal) {
  runtime::VirtualDevice device(kFree, 1000, [](double) { return runtime::HandTarget{}; });
  device.open();
  ExcitationLoopSettings diagonal = settings(15);
  diagonal.excitation.direction = {std::sqrt(0.5), 0, -std::sqrt(0.5)};
  ExcitationLoop loop(device, diagonal);
  EXPECT_EQ(run(loop), ExcitationEnd::Done);
  double across = 0, along = 0;
  for (const Vec3& x : loop.record().position) {
    across = std::max({across, std::abs(x[1]), std::abs(x[2])});
    along = std::max(along, std::abs(x[0]));
  }
  EXPECT_GT(along, 1e-3);
  EXPECT_LT(across, 1e-9);
  const identify::AxisEstimate e = identify::estimate_axis(loop.record(), 0.03);
  ASSERT_EQ(e.problem, "");
  EXPECT_NEAR(e.damping[0].value, kFree.damping, 0.05 * kFree.damping);
  const double friction = std::sqrt(2.0) * kFree.coulomb_friction;  // both axes rub
  EXPECT_NEAR(e.friction.value, friction, 0.05 * friction);
}

using test::ScriptedDevice;

/// Where a tip on the x axis or elsewhere is at a step.
DeviceReading at(const Vec3& position) {
  return {position, {}, 0};
}

TEST(ExcitationLoop, EndsWithoutForceWhenTheTipLeavesTheBox) {
  ScriptedDevice device;
  device.place = [](int i) { return at({0, 1e-4 * i, 0}); };
  ExcitationLoop loop(device, settings(10));
  EXPECT_EQ(run(loop), ExcitationEnd::LeftBox);
  EXPECT_NEAR(device.reads, 201, 2);  // 20 mm in steps of 0.1 mm
  EXPECT_EQ(norm(device.commanded.back()), 0);
}

TEST(ExcitationLoop, EndsWithoutForceWhenTheTipIsTooFast) {
  ScriptedDevice device;
  device.place = [](int i) { return at({i < 500 ? 0.0 : 1e-3 * (i - 500), 0, 0}); };  // 1 m/s
  ExcitationLoop loop(device, settings(10));
  EXPECT_EQ(run(loop), ExcitationEnd::TooFast);
  EXPECT_EQ(norm(device.commanded.back()), 0);
}

TEST(ExcitationLoop, EndsWithoutForceWhenTheDeviceIsLostOrSilent) {
  ScriptedDevice lost;
  lost.status_of_read = [](int i) { return i < 100 ? DeviceStatus::Good : DeviceStatus::Lost; };
  ExcitationLoop first(lost, settings(10));
  EXPECT_EQ(run(first), ExcitationEnd::Lost);
  EXPECT_EQ(norm(lost.commanded.back()), 0);

  ScriptedDevice silent;
  silent.status_of_read = [](int i) { return i < 100 ? DeviceStatus::Good : DeviceStatus::Late; };
  ExcitationLoop second(silent, settings(10));
  EXPECT_NE(run(second), ExcitationEnd::Done);
  EXPECT_EQ(norm(silent.commanded.back()), 0);
  EXPECT_GT(second.stale(), 0U);
}

/// What a saturated device gives is not known: constants from the commanded force would be wrong.
TEST(ExcitationLoop, EndsWithoutForceWhenTheDeviceSaturates) {
  ScriptedDevice device;
  device.status_of_command = [](int i) {
    return i < 300 ? DeviceStatus::Good : DeviceStatus::Saturated;
  };
  ExcitationLoop loop(device, settings(10));
  EXPECT_EQ(run(loop), ExcitationEnd::Saturated);
  EXPECT_EQ(norm(device.commanded.back()), 0);
  EXPECT_EQ(device.reads, 301);
}

/// In a step without a new sample the last command goes on: the record stays that of what acted.
TEST(ExcitationLoop, RepeatsTheLastCommandWithoutANewSample) {
  ScriptedDevice device;
  device.status_of_read = [](int i) {
    return i % 2 == 1 ? DeviceStatus::Late : DeviceStatus::Good;
  };
  ExcitationLoop loop(device, settings(1));
  Vec3 commanded{};
  for (int i = 1; i <= 900; ++i) {
    ASSERT_TRUE(loop.tick(0));
    if (i % 2 == 0)
      EXPECT_EQ(device.commanded.back(), commanded) << i;
    else
      commanded = device.commanded.back();
  }
  EXPECT_EQ(loop.record().time.size(), 450U);
}

}  // namespace
}  // namespace palpate::app
