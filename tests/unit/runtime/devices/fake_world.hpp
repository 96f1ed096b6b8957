// SPDX-License-Identifier: AGPL-3.0-or-later
// What stands behind the fake vendor libraries: a simulated device, and the faults a test injects.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <thread>

#include "format/vec3.hpp"
#include "runtime/devices/device_simulated.hpp"

namespace palpate::test {

/// SI throughout; each fake translates to the units of its vendor. The simulated device moves on by
/// one millisecond with each force that it is sent.
struct FakeWorld {
  static runtime::SimulatedDeviceSettings settings() {
    runtime::SimulatedDeviceSettings s;
    s.mass = 0.1;
    s.damping = 2;
    s.hand_stiffness = 200;
    s.delay_samples = 0;
    return s;
  }

  void reset() {
    const std::scoped_lock lock(mutex);
    device = runtime::SimulatedDevice(settings());
    force = {};
    buttons = 0;
    present = true;
    unplugged = saturated = late = forces_enabled = false;
    forces = opened = closed = stall_ms = 0;
    system_type = 33;
    watchdog_ticks = 0;
    queued_error = 0;
    has_watchdog = true;
    opened_name.clear();
  }
  /// Where a driver waits for its device. Once it takes as long as a test says.
  void wait_for_device() {
    std::this_thread::sleep_for(std::chrono::milliseconds(stall_ms.exchange(0)));
  }
  void send_force(const Vec3& f) {
    const std::scoped_lock lock(mutex);
    force = f;
    device.step(1e-3, f);
    ++forces;
  }
  Vec3 position() {
    const std::scoped_lock lock(mutex);
    return device.position();
  }
  Vec3 velocity() {
    const std::scoped_lock lock(mutex);
    return device.velocity();
  }
  Vec3 last_force() {
    const std::scoped_lock lock(mutex);
    return force;
  }
  void place(const Vec3& x, const Vec3& v) {
    const std::scoped_lock lock(mutex);
    device.place(x, v);
  }

  /// The hand that holds the device wants to be here.
  void pull_to(const Vec3& x) {
    const std::scoped_lock lock(mutex);
    device.set_target(x, {});
  }
  Vec3 hand_force() {
    const std::scoped_lock lock(mutex);
    return device.hand_force();
  }

  std::mutex mutex;
  runtime::SimulatedDevice device{settings()};
  Vec3 force{};  ///< N, the last one sent
  std::atomic<int> buttons{0};
  std::atomic<bool> present{true}, unplugged{false}, saturated{false}, late{false};
  std::atomic<bool> forces_enabled{false};
  std::atomic<int> forces{0}, opened{0}, closed{0}, stall_ms{0};

  // Each of one vendor.
  std::atomic<int> system_type{33};       ///< dhd: an omega.3
  std::atomic<int> watchdog_ticks{0};     ///< dhd: as it was set, in 125 us; 0: never
  std::atomic<bool> has_watchdog{true};   ///< dhd
  std::atomic<unsigned> queued_error{0};  ///< hd: an error that its queue still holds
  std::string opened_name;                ///< hd: the device that was asked for
};

}  // namespace palpate::test

/// The world of a fake library: the one that the binding under test talks to.
extern "C" palpate::test::FakeWorld* fake_world();
