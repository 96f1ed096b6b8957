// SPDX-License-Identifier: Apache-2.0
// The force loop in a real-time thread, or in the thread of the driver, with a watchdog.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "runtime/device.hpp"
#include "runtime/loop_body.hpp"
#include "runtime/realtime.hpp"
#include "runtime/safety.hpp"

namespace palpate::runtime {

struct LoopThreadSettings {
  double rate = 1000;  ///< Hz; for a driver with its own thread: its expected rate
  /// s without a step after which the device is halted
  double watchdog = default_watchdog(1000);
  RealtimeSettings realtime;
  double duration = 0;  ///< s from the first step, rounded to periods; 0: until it is stopped
  /// s before a step is due at which the thread wakes, to read the clock until it is due; up to
  /// kMostEarly of a period. 0: it sleeps until then.
  double wake_early = 0;
  /// Linux takes the processor away from a real-time thread that keeps it for 95 % of a second.
  static constexpr double kMostEarly = 0.8;
};

/// Runs a loop until it is stopped or the device is lost. Steps are due at absolute times, so
/// that they do not drift. A step that ends after the next was due is an overrun: the missed steps
/// are skipped, not made up for in a burst. A loop of N periods thus takes N steps less those that
/// it misses. When no step begins for longer than the watchdog
/// allows, the device is halted for the rest of the session.
class LoopThread {
 public:
  /// Starts at once. The device is open. @throws Error(Configuration) for settings out of range,
  /// and for an early wake where the driver calls the loop from its own thread.
  LoopThread(LoopBody& loop, Device& device, const LoopThreadSettings& settings);
  ~LoopThread();  ///< stops
  LoopThread(const LoopThread&) = delete;
  LoopThread& operator=(const LoopThread&) = delete;

  /// Ends the loop after the current step, commands zero force, and waits. The device stays open.
  void stop() noexcept;
  bool running() const noexcept { return running_.load(); }
  bool halted() const noexcept { return halted_.load(); }  ///< by the watchdog
  /// One line on what the system refused (see become_realtime); empty when nothing. Valid after the
  /// first step.
  std::string missing_rights() const;

 private:
  void begin(std::int64_t first_due) noexcept;
  void run();
  bool foreign_step() noexcept;
  void watch();
  void finish() noexcept;

  LoopBody& loop_;
  Device& device_;
  LoopThreadSettings settings_;
  std::int64_t period_ = 0;  ///< ns
  std::int64_t early_ = 0;   ///< ns
  std::int64_t due_ = 0;     ///< monotonic, ns
  std::int64_t end_ = 0;     ///< monotonic, ns: no step is due from here on
  std::atomic<bool> stop_{false}, running_{true}, halted_{false};
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::string missing_;
  std::thread thread_, watchdog_;
};

}  // namespace palpate::runtime
