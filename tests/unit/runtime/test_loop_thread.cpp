// SPDX-License-Identifier: AGPL-3.0-or-later
// The thread of the force loop. Wake-up times depend on the machine and are not asserted; the
// treatment of late steps is.
#include "runtime/force_loop.hpp"
#include "runtime/loop_thread.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <thread>

#include "format/error.hpp"
#include "tests/unit/runtime/loop_rig.hpp"

namespace palpate::test {
namespace {

using runtime::DeviceStatus;
using runtime::ForceLoop;
using runtime::LoopThread;
using runtime::LoopThreadSettings;

LoopThreadSettings ordinary(double rate, double watchdog) {
  LoopThreadSettings settings;
  settings.rate = rate;
  settings.watchdog = watchdog;
  settings.realtime.priority = 0;
  return settings;
}

void wait_until_over(const LoopThread& thread) {
  for (int i = 0; i < 5000 && thread.running(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

TEST(LoopThread, StepsAndStopsWithoutForce) {
  LoopRig rig;
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
  LoopRig rig;
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

TEST(LoopThread, OfADurationTakesOneStepInEachPeriodAndEndsByItself) {
  // The steps of a period that a busy machine missed are counted, so that the sum is exact.
  LoopRig rig;
  LoopThreadSettings settings = ordinary(1000, 10);
  settings.duration = 0.25;
  LoopThread thread(rig.loop, rig.device, settings);
  wait_until_over(thread);
  ASSERT_FALSE(thread.running());
  thread.stop();
  EXPECT_EQ(rig.loop.counts().steps + rig.loop.counts().missed, 250U);
  EXPECT_EQ(rig.device.commanded.back(), Vec3{});
}

/// Keeps when its steps were due, and how many periods passed without one.
class DueTimes : public runtime::LoopBody {
 public:
  bool tick(std::int64_t due) noexcept override {
    premature += runtime::monotonic_ns() < due ? 1 : 0;
    if (count < due_at.size()) due_at[count++] = due;
    return count < due_at.size();
  }
  void count_overrun(std::int64_t periods) noexcept override { missed += periods; }
  std::int64_t heartbeat() const noexcept override { return due_at[0]; }

  std::array<std::int64_t, 40> due_at{};  ///< ns
  std::size_t count = 0, premature = 0;
  std::int64_t missed = 0;
};

TEST(LoopThread, StepsAreDueAPeriodApartOfTheRate) {
  DueTimes loop;
  ScriptedDevice device;
  LoopThread thread(loop, device, ordinary(2500, 10));
  wait_until_over(thread);
  thread.stop();
  ASSERT_EQ(loop.count, loop.due_at.size());
  const auto periods = static_cast<std::int64_t>(loop.count) - 1 + loop.missed;
  EXPECT_EQ(loop.due_at.back() - loop.due_at.front(), 400'000 * periods);
}

TEST(LoopThread, ThatWakesEarlyStepsWhenAStepIsDue) {
  DueTimes loop;
  ScriptedDevice device;
  LoopThreadSettings settings = ordinary(2500, 10);
  settings.wake_early = 250e-6;
  LoopThread thread(loop, device, settings);
  wait_until_over(thread);
  thread.stop();
  ASSERT_EQ(loop.count, loop.due_at.size());
  EXPECT_EQ(loop.premature, 0U);
  const auto periods = static_cast<std::int64_t>(loop.count) - 1 + loop.missed;
  EXPECT_EQ(loop.due_at.back() - loop.due_at.front(), 400'000 * periods);
}

TEST(LoopThread, OfADurationCountsTheMissedPeriodsUpToItsEnd) {
  // The fifth step takes longer than the rest of the session.
  LoopRig rig;
  rig.device.before_read = [&](int step) {
    if (step == 4) std::this_thread::sleep_for(std::chrono::milliseconds(60));
  };
  LoopThreadSettings settings = ordinary(1000, 10);
  settings.duration = 0.04;
  LoopThread thread(rig.loop, rig.device, settings);
  wait_until_over(thread);
  thread.stop();
  EXPECT_LE(rig.loop.counts().steps, 6U);
  EXPECT_EQ(rig.loop.counts().steps + rig.loop.counts().missed, 40U);
}

TEST(LoopThread, TheWatchdogHaltsADeviceWhoseLoopHangs) {
  LoopRig rig;
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

TEST(LoopThread, TheWatchdogOfASlowLoopIsAsPatientAsItsPeriod) {
  // 20 periods of 0.1 s: no step for 20 ms is what such a loop is like.
  LoopRig rig;
  LoopThread thread(rig.loop, rig.device, ordinary(10, runtime::default_watchdog(10)));
  while (rig.loop.heartbeat() == 0) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  thread.stop();
  EXPECT_FALSE(thread.halted());
  EXPECT_DOUBLE_EQ(runtime::default_watchdog(4000), 0.005);
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
  LoopRig rig;
  rig.device.status_of_read = [](int step) {
    return step < 10 ? DeviceStatus::Good : DeviceStatus::Lost;
  };
  LoopThread thread(rig.loop, rig.device, ordinary(2000, 10));
  wait_until_over(thread);
  EXPECT_FALSE(thread.running());
  EXPECT_EQ(drain(rig.queue).size(), 11U);
}

TEST(LoopThread, MissingRightsAreSaidInOneLineAndTheLoopRunsAllTheSame) {
  LoopRig rig;
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
  LoopRig rig;
  EXPECT_THROW(LoopThread(rig.loop, rig.device, ordinary(0, 1)), Error);
  EXPECT_THROW(LoopThread(rig.loop, rig.device, ordinary(1e9, 1)), Error);
  for (const double duration : {-1.0, 2e9, std::numeric_limits<double>::quiet_NaN()}) {
    LoopThreadSettings settings = ordinary(1000, 1);
    settings.duration = duration;
    EXPECT_THROW(LoopThread(rig.loop, rig.device, settings), Error) << duration;
  }
  EXPECT_THROW(LoopThread(rig.loop, rig.device, ordinary(1000, 0)), Error);
  for (const double early : {-1e-6, 0.81e-3, std::numeric_limits<double>::quiet_NaN()}) {
    LoopThreadSettings settings = ordinary(1000, 1);
    settings.wake_early = early;
    EXPECT_THROW(LoopThread(rig.loop, rig.device, settings), Error) << early;
  }
}

TEST(LoopThread, CannotWakeEarlyWhereTheDriverKeepsTheTime) {
  LateStarter device;
  palpate_state state(plate_body(), {0.3, 5e-3});
  ForceLoop loop(device, state, kPatient, nullptr);
  LoopThreadSettings settings = ordinary(1000, 1);
  settings.wake_early = 1e-4;
  EXPECT_THROW(LoopThread(loop, device, settings), Error);
}

}  // namespace
}  // namespace palpate::test
