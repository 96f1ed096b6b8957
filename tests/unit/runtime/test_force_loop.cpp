// SPDX-License-Identifier: AGPL-3.0-or-later
// The force loop with devices that behave, and with devices that do not. Times of waking up are not
// asserted: they are the machine's. What happens to late steps is.
#include "runtime/force_loop.hpp"
#include "runtime/handles.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "format/error.hpp"
#include "runtime/devices/device_virtual.hpp"
#include "runtime/loop_thread.hpp"
#include "runtime/palpate.h"
#include "runtime/realtime.hpp"
#include "tests/support/bodies.hpp"
#include "tests/unit/runtime/scripted_device.hpp"

namespace palpate::test {
namespace {

using runtime::DeviceReading;
using runtime::DeviceStatus;
using runtime::ForceLoop;
using runtime::LoopThread;
using runtime::LoopThreadSettings;
using runtime::SafetySettings;
using runtime::StepQueue;

const SafetySettings kPatient{0, 1000, 1000, 1e6};  // no ramp, no cut-off

LoopThreadSettings ordinary(double rate, double watchdog) {
  LoopThreadSettings settings;
  settings.rate = rate;
  settings.watchdog = watchdog;
  settings.realtime.priority = 0;
  return settings;
}

const palpate_library& plate_body() {
  static const palpate_library body(
      plate(8, 0.08, [](const Vec3&) { return wall_response(170, 120); }));
  return body;
}

/// Presses 20 um a step from 0.5 mm above.
DeviceReading pressing(int step) {
  return {{0.04, 0.04, 5e-4 - 2e-5 * step}, {0, 0, -0.02}, 0};
}

std::vector<RecordedStep> drain(StepQueue& queue) {
  std::vector<RecordedStep> steps;
  RecordedStep step;
  while (queue.try_dequeue(step)) steps.push_back(step);
  return steps;
}

struct Rig {
  explicit Rig(const SafetySettings& safety = kPatient, std::size_t room = 4096)
      : state(plate_body(), {0.3, 5e-3}), queue(room), loop(device, state, safety, &queue) {
    device.place = pressing;
  }
  ScriptedDevice device;
  palpate_state state;
  StepQueue queue;
  ForceLoop loop;
};

TEST(ForceLoop, CommandsTheForceOfTheBodyAndRecordsEveryStep) {
  Rig rig;
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
  Rig rig;
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
  Rig rig;
  rig.device.status_of_command = [](int step) {
    return step < 7 ? DeviceStatus::Good : DeviceStatus::Lost;
  };
  int ticks = 0;
  while (rig.loop.tick(runtime::monotonic_ns())) ++ticks;
  EXPECT_EQ(ticks, 7);
}

TEST(ForceLoop, CountsSaturationAndStaleSamplesAndGoesOn) {
  Rig rig;
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
  Rig rig;
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
  Rig rig(kPatient, 50);
  for (int i = 0; i < 80; ++i) EXPECT_TRUE(rig.loop.tick(runtime::monotonic_ns()));
  EXPECT_EQ(rig.device.commanded.size(), 80U);
  EXPECT_EQ(rig.loop.counts().unrecorded, 30U);
  EXPECT_EQ(drain(rig.queue).size(), 50U);
}

TEST(ForceLoop, SafetyStandsBetweenTheBodyAndTheDevice) {
  Rig rig({0, 0.05, 1000, 1e6});
  for (int i = 0; i < 200; ++i) rig.loop.tick(runtime::monotonic_ns());
  EXPECT_NEAR(norm(rig.device.commanded.back()), 0.05, 1e-12);
  EXPECT_GT(rig.loop.counts().clamped, 50U);
  EXPECT_GT(norm(rig.state.contact.observation().force), 0.1);
}

void wait_until_over(const LoopThread& thread) {
  for (int i = 0; i < 5000 && thread.running(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

TEST(LoopThread, StepsAndStopsWithoutForce) {
  Rig rig;
  {
    LoopThread thread(rig.loop, rig.device, ordinary(2000, 10));
    while (rig.loop.heartbeat() == 0) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_TRUE(thread.running());
    thread.stop();
    EXPECT_FALSE(thread.running());
    EXPECT_FALSE(thread.halted());
  }
  EXPECT_GT(rig.loop.counts().steps, 1U);
  EXPECT_EQ(rig.device.commanded.back(), Vec3{});
  EXPECT_EQ(rig.loop.counts().wake.count(), rig.loop.counts().steps);
}

TEST(LoopThread, MissedStepsAreLeftOutNotMadeUpFor) {
  // Every read takes three periods: at most one step in three, and each an overrun.
  Rig rig;
  std::atomic<int> reads{0};
  rig.device.before_read = [&](int) {
    ++reads;
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
  };
  const std::int64_t start = runtime::monotonic_ns();
  {
    LoopThread thread(rig.loop, rig.device, ordinary(1000, 10));
    while (reads < 10) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    thread.stop();
  }
  const double periods = 1e-6 * static_cast<double>(runtime::monotonic_ns() - start);
  const auto& counts = rig.loop.counts();
  EXPECT_GT(counts.steps, 2U);
  EXPECT_LE(static_cast<double>(counts.steps), periods / 3 + 1);
  EXPECT_GE(counts.overruns + 1, counts.steps);
}

TEST(LoopThread, TheWatchdogHaltsADeviceWhoseLoopHangs) {
  Rig rig;
  std::atomic<bool> hang{true};
  rig.device.before_read = [&](int step) {
    while (step == 5 && hang) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  LoopThread thread(rig.loop, rig.device, ordinary(1000, 0.1));
  for (int i = 0; i < 5000 && !rig.device.halted; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(rig.device.halted);  // while the loop still hangs
  hang = false;
  thread.stop();
  EXPECT_TRUE(thread.halted());
}

/// A driver whose thread takes its time before the first call.
class LateStarter : public ScriptedDevice {
 public:
  ~LateStarter() override { stop_calls(); }
  bool has_own_thread() const noexcept override { return true; }
  void start_calls(std::function<bool()> step) override {
    thread_ = std::thread([this, step] {
      std::this_thread::sleep_for(std::chrono::milliseconds(250));
      for (int i = 0; i < 20 && step(); ++i) ++called_;
    });
  }
  void stop_calls() noexcept override {
    if (thread_.joinable()) thread_.join();
  }
  std::atomic<int> called_{0};

 private:
  std::thread thread_;
};

TEST(LoopThread, TheWatchdogWaitsForTheFirstStep) {
  LateStarter device;
  device.place = pressing;
  palpate_state state(plate_body(), {0.3, 5e-3});
  ForceLoop loop(device, state, kPatient, nullptr);
  LoopThread thread(loop, device, ordinary(1000, 0.1));
  for (int i = 0; i < 2000 && device.called_ == 0; ++i) {
    EXPECT_FALSE(thread.halted());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_GT(device.called_, 0);
  thread.stop();
}

TEST(LoopThread, EndsByItselfWhenTheDeviceIsLost) {
  Rig rig;
  rig.device.status_of_read = [](int step) {
    return step < 10 ? DeviceStatus::Good : DeviceStatus::Lost;
  };
  LoopThread thread(rig.loop, rig.device, ordinary(2000, 10));
  wait_until_over(thread);
  EXPECT_FALSE(thread.running());
  EXPECT_EQ(drain(rig.queue).size(), 11U);
}

TEST(LoopThread, MissingRightsAreSaidInOneLineAndTheLoopRunsAllTheSame) {
  Rig rig;
  LoopThreadSettings settings = ordinary(1000, 10);
  settings.realtime.priority = 1000;  // what no system grants
  settings.realtime.core = 1000;
  LoopThread thread(rig.loop, rig.device, settings);
  while (rig.loop.heartbeat() == 0) std::this_thread::yield();
  const std::string missing = thread.missing_rights();
  thread.stop();
  EXPECT_NE(missing.find("SCHED_FIFO"), std::string::npos) << missing;
  EXPECT_NE(missing.find("not pinned"), std::string::npos) << missing;
  EXPECT_EQ(missing.find('\n'), std::string::npos);
  EXPECT_GT(rig.loop.counts().steps, 0U);
}

TEST(LoopThread, RefusesSettingsOutOfRange) {
  Rig rig;
  EXPECT_THROW(LoopThread(rig.loop, rig.device, ordinary(0, 1)), Error);
  EXPECT_THROW(LoopThread(rig.loop, rig.device, ordinary(1e9, 1)), Error);
  EXPECT_THROW(LoopThread(rig.loop, rig.device, ordinary(1000, 0)), Error);
}

TEST(VirtualDevice, ASessionComesOutTheSameEveryTime) {
  const auto play = [] {
    runtime::SimulatedDeviceSettings settings;
    settings.hand_stiffness = 400;
    settings.hand_damping = 4;
    runtime::VirtualDevice device(settings, 1000, [](double t) {
      return runtime::HandTarget{{0.04, 0.04, 0.002 - 0.01 * t}, {0, 0, -0.01}};
    });
    device.open();
    palpate_state state(plate_body(), {0.3, 5e-3});
    StepQueue queue(2000);
    ForceLoop loop(device, state, kPatient, &queue);
    for (int i = 0; i < 1000; ++i) loop.tick(runtime::monotonic_ns());
    return drain(queue);
  };
  const auto once = play();
  const auto again = play();
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].position, again[i].position);
    EXPECT_EQ(once[i].force, again[i].force);
  }
  EXPECT_GT(once.back().force[2], 0.3);
}

}  // namespace
}  // namespace palpate::test
