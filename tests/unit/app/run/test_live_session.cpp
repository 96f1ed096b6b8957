// SPDX-License-Identifier: AGPL-3.0-or-later
// Live sessions: what is recorded, and what remains of a session that fails.
#include "app/run/live_session.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "format/error.hpp"
#include "runtime/devices/device_virtual.hpp"
#include "runtime/palpate.h"
#include "tests/support/bodies.hpp"
#include "tests/support/small_disk.hpp"
#include "tests/unit/app/run/live_play.hpp"

namespace palpate::app {
namespace {

Library wall_plate() {
  return test::plate(8, 0.08, [](const Vec3&) { return test::wall_response(170, 120); });
}

LiveSettings quick(double duration) {
  LiveSettings settings;
  settings.contact.friction = 0.3;
  settings.loop.rate = 1000;
  settings.loop.realtime.priority = 0;
  settings.loop.watchdog = settings.safety.watchdog = 10;  // whatever the pace of this machine
  settings.safety.ramp = 0;
  settings.duration = duration;
  return settings;
}

runtime::SimulatedDeviceSettings with_hand() {
  runtime::SimulatedDeviceSettings settings;
  settings.damping = 2;
  settings.hand_stiffness = 400;
  settings.hand_damping = 4;
  return settings;
}

TEST(LiveSession, PressesAndRecordsInTheFrameOfTheDevice) {
  // The pose moves the body, and the hand moves with it.
  const palpate_library body(wall_plate());
  LiveSettings settings = quick(0.4);
  settings.pose.position = {0.5, -0.25, 1};
  settings.search_rate = 1000;
  runtime::VirtualDevice device(with_hand(), 1000, [](double t) {
    return runtime::HandTarget{{0.54, -0.21, 1.001 - 0.03 * t}, {0, 0, -0.03}};
  });
  const std::atomic<bool> stop{false};
  const auto [outcome, recording] = play_live(device, body, settings, stop);
  const std::vector<RecordedStep>& steps = recording.steps;
  ASSERT_GT(steps.size(), 30U);
  EXPECT_EQ(steps.size(), outcome.counts.steps);
  const auto touching = [](const RecordedStep& s) { return (s.status & PALPATE_CONTACT) != 0; };
  const auto first = std::find_if(steps.begin(), steps.end(), touching);
  ASSERT_NE(first, steps.end());
  EXPECT_NEAR(first->contact_point[0], 0.54, 1e-6);
  EXPECT_NEAR(first->contact_point[2], 1.0, 1e-9);
  for (std::size_t i = 1; i < steps.size(); ++i) {
    EXPECT_GT(steps[i].time_ns, steps[i - 1].time_ns);
  }
}

TEST(LiveSession, LastsAsLongAsItIsToldFromItsFirstStep) {
  const palpate_library body(wall_plate());
  runtime::VirtualDevice device(with_hand(), 1000, [](double) { return runtime::HandTarget{}; });
  const std::atomic<bool> stop{false};
  const auto [outcome, recording] = play_live(device, body, quick(0.3), stop);
  EXPECT_EQ(outcome.counts.steps + outcome.counts.missed, 300U);
  EXPECT_EQ(recording.steps.size(), outcome.counts.steps);
}

TEST(LiveSession, EndsWhenStopIsSet) {
  const palpate_library body(wall_plate());
  runtime::VirtualDevice device(with_hand(), 1000, [](double) { return runtime::HandTarget{}; });
  const std::atomic<bool> stop{true};
  const LiveOutcome outcome = play_live(device, body, quick(0), stop).outcome;
  EXPECT_FALSE(outcome.counts.lost);
  EXPECT_FALSE(outcome.halted);
}

/// Is lost after some steps.
class FailingDevice : public runtime::VirtualDevice {
 public:
  using VirtualDevice::VirtualDevice;
  runtime::DeviceStatus read(runtime::DeviceReading& reading) noexcept override {
    return ++reads_ > 25 ? runtime::DeviceStatus::Lost : VirtualDevice::read(reading);
  }

 private:
  int reads_ = 0;
};

TEST(LiveSession, RecordsUntilTheDeviceIsLost) {
  const palpate_library body(wall_plate());
  FailingDevice device(with_hand(), 1000, [](double) { return runtime::HandTarget{}; });
  const std::atomic<bool> stop{false};
  const auto [outcome, recording] = play_live(device, body, quick(0), stop);
  EXPECT_TRUE(outcome.counts.lost);
  EXPECT_EQ(recording.steps.size(), 26U);
  EXPECT_TRUE(recording.steps.back().status & PALPATE_LOOP_DEVICE_LOST);
}

/// Has no new sample after some steps.
class SilentDevice : public runtime::VirtualDevice {
 public:
  using VirtualDevice::VirtualDevice;
  runtime::DeviceStatus read(runtime::DeviceReading& reading) noexcept override {
    const runtime::DeviceStatus status = VirtualDevice::read(reading);
    return ++reads_ > 25 ? runtime::DeviceStatus::Late : status;
  }

 private:
  int reads_ = 0;
};

TEST(LiveSession, EndsWhenTheDeviceFallsSilent) {
  const palpate_library body(wall_plate());
  SilentDevice device(with_hand(), 1000, [](double) { return runtime::HandTarget{}; });
  LiveSettings settings = quick(0);
  settings.loop.rate = 200;
  set_watchdog(settings, {});
  EXPECT_DOUBLE_EQ(settings.safety.watchdog, 0.1);
  set_watchdog(settings, 0.02);
  settings.loop.watchdog = 10;  // whatever the pace of this machine
  const std::atomic<bool> stop{false};
  const auto [outcome, recording] = play_live(device, body, settings, stop);
  EXPECT_TRUE(outcome.counts.lost);
  EXPECT_TRUE(outcome.counts.silent);
  EXPECT_TRUE(recording.steps.back().status & PALPATE_LOOP_DEVICE_LOST);
  EXPECT_FALSE(recording.steps.back().status & PALPATE_CONTACT);
}

/// Remembers the last force.
class ListeningDevice : public runtime::VirtualDevice {
 public:
  using VirtualDevice::VirtualDevice;
  runtime::DeviceStatus command(const Vec3& force) noexcept override {
    last_ = force;
    return VirtualDevice::command(force);
  }
  const Vec3& last() const { return last_; }

 private:
  Vec3 last_{};
};

TEST(LiveSession, EndsWithoutForceWhenTheDiskIsFullAndKeepsTheJournal) {
  const samples::TemporaryFolder folder;
  const palpate_library body(wall_plate());
  ListeningDevice device(with_hand(), 1000, [](double) {
    return runtime::HandTarget{{0.04, 0.04, -0.003}, {}};
  });
  device.open();
  const LiveSettings settings = quick(0);
  RecordingHeading heading;
  heading.settings = session_settings(settings);
  const std::atomic<bool> stop{false};
  LiveOutcome outcome;
  {
    SessionRecorder recorder(folder / "recording.h5", heading);
    const samples::SmallDisk disk(200'000);  // about a thousand steps
    outcome = run_live(device, body, settings, recorder, stop);
  }
  ASSERT_TRUE(outcome.not_recorded);
  EXPECT_NE(std::string(outcome.not_recorded->what()).find("recording.journal"), std::string::npos);
  EXPECT_EQ(norm(device.last()), 0);
  const Recovered recovered = recover(folder / "recording.journal", folder / "recording.h5");
  const Recording recording = read_recording(folder / "recording.h5");
  EXPECT_EQ(recording.steps.size(), recovered.steps);
  EXPECT_GT(recovered.steps, 100U);
  EXPECT_LT(recovered.steps, outcome.counts.steps);
  EXPECT_EQ(recording.provenance.steps.back().stage, "recover");
  EXPECT_FALSE(std::filesystem::exists(folder / "recording.journal"));
}

}  // namespace
}  // namespace palpate::app
