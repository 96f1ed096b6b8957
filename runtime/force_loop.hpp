// SPDX-License-Identifier: Apache-2.0
// One device, one tool on one body, step after step.
#pragma once

#include <readerwriterqueue/readerwritercircularbuffer.h>

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "format/recording.hpp"
#include "runtime/device.hpp"
#include "runtime/latency_histogram.hpp"
#include "runtime/loop_body.hpp"
#include "runtime/posed_contact.hpp"
#include "runtime/realtime.hpp"
#include "runtime/safety.hpp"

namespace palpate::runtime {

/// Steps on their way from the force loop to the recorder.
using StepQueue = moodycamel::BlockingReaderWriterCircularBuffer<RecordedStep>;

/// Copies the observation of the last step (contact, deflections, energies) into `step`.
void enter_observation(const PosedContact& contact, RecordedStep& step) noexcept;

/// A sample through the safety functions and the contact to the force: a step of the force loop
/// without its device, which a replay repeats. `lost`: no new sample for too long. noexcept,
/// allocation-free.
struct GuardedStep {
  Vec3 force{};              ///< N, to command
  std::uint32_t status = 0;  ///< step_status bits
  bool lost = false;
};
GuardedStep guarded_step(Safety& safety, PosedContact& contact, const DeviceReading& reading,
                         bool fresh, double dt) noexcept;

/// Counts of the loop, to be read when it has stopped.
struct LoopCounts {
  std::uint64_t steps = 0;
  std::uint64_t late = 0;       ///< gaps longer than the watchdog allows
  std::uint64_t overruns = 0;   ///< steps that ended after the next was due
  std::uint64_t missed = 0;     ///< periods without a step, after overruns
  std::uint64_t saturated = 0;  ///< the device gave less force than commanded
  std::uint64_t stale = 0;      ///< the device had no new sample
  std::uint64_t clamped = 0;
  std::uint64_t cut_off = 0;   ///< steps that the safety functions leave without their force
  std::uint64_t outdated = 0;  ///< steps whose last new sample is older than the watchdog allows
  std::uint64_t rejected = 0;  ///< samples farther away than a tip can have moved
  std::uint64_t not_finite = 0;
  std::uint64_t unrecorded = 0;  ///< steps for which the queue had no room
  bool lost = false;             ///< the device is lost
  bool silent = false;           ///< lost because it sent no new sample for too long
  LatencyHistogram wake;         ///< from the time a step was due to its beginning
  LatencyHistogram compute;      ///< reading, stepping and commanding
};

/// The force loop: reads the device, steps the contact, passes the force through Safety, commands
/// it, records. LoopThread or the thread of a vendor's driver calls tick(), which is noexcept,
/// allocation-free and lock-free except for the calls of the device's driver.
class ForceLoop final : public LoopBody {
 public:
  /// All must outlive the loop; queue may be null.
  ForceLoop(Device& device, PosedContact& contact, const SafetySettings& safety, StepQueue* queue);

  /// One step. due: when it should have begun, on the monotonic clock, ns. False when the device is
  /// lost: the loop is over.
  bool tick(std::int64_t due) noexcept override { return tick(due, monotonic_ns()); }
  /// The same at a time that the caller states: `began`, > 0, monotonic, ns.
  bool tick(std::int64_t due, std::int64_t began) noexcept;
  /// missed: periods that pass without a step.
  void count_overrun(std::int64_t missed) noexcept override {
    ++counts_.overruns;
    counts_.missed += static_cast<std::uint64_t>(missed);
  }

  /// When the last step began, monotonic ns; 0 before the first. From any thread.
  std::int64_t heartbeat() const noexcept override {
    return heartbeat_.load(std::memory_order_relaxed);
  }
  const LoopCounts& counts() const noexcept { return counts_; }

 private:
  std::uint32_t note(DeviceStatus status) noexcept;
  void count(std::uint32_t status) noexcept;
  void record(const DeviceReading& reading, const Vec3& force, std::uint32_t status,
              std::int64_t began) noexcept;

  Device& device_;
  PosedContact& contact_;
  Safety safety_;
  StepQueue* queue_;
  LoopCounts counts_;
  std::int64_t start_ = 0, last_ = 0;  ///< monotonic, ns
  std::atomic<std::int64_t> heartbeat_{0};
};

}  // namespace palpate::runtime
