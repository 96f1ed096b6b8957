// SPDX-License-Identifier: AGPL-3.0-or-later
// Excites a device along one axis and records its motion.
#pragma once

#include <atomic>
#include <cstdint>

#include "fitting/measurement/identify/directions.hpp"
#include "fitting/measurement/identify/excitation.hpp"
#include "fitting/measurement/identify/motion_record.hpp"
#include "runtime/device.hpp"
#include "runtime/loop_body.hpp"
#include "runtime/safety.hpp"

namespace palpate::app {

struct ExcitationLoopSettings {
  identify::ExcitationSettings excitation;
  runtime::SafetySettings safety;
  double rate = 1000;  ///< Hz
  /// The device advances by a period a command, whatever the clock says: its time is counted.
  bool counted_time = false;
};

/// Why an excitation ended.
enum class ExcitationEnd : std::uint8_t {
  Running,
  Done,
  LeftBox,  ///< the tip was farther from the start than the box
  TooFast,
  Saturated,  ///< the device gave less force than commanded: the force that acted is not known
  Lost,       ///< the device
  Silent      ///< it sent no new sample for too long
};

/// Reads the device, commands the excitation through the safety functions of the force loop, and
/// records what was commanded, in the frame whose first axis is the direction of the excitation. A
/// cut-off ends it: from then on there is no force. tick() is noexcept and allocation-free.
class ExcitationLoop final : public runtime::LoopBody {
 public:
  /// The device is open and must outlive the loop. @throws Error(Configuration) for settings out of
  /// range.
  ExcitationLoop(runtime::Device& device, const ExcitationLoopSettings& settings);

  bool tick(std::int64_t due) noexcept override;
  void count_overrun(std::int64_t missed) noexcept override {
    missed_ += static_cast<std::uint64_t>(missed);
  }
  std::int64_t heartbeat() const noexcept override {
    return heartbeat_.load(std::memory_order_relaxed);
  }

  // To be read when the loop has stopped.
  ExcitationEnd end() const noexcept { return end_; }
  const identify::MotionRecord& record() const noexcept { return record_; }
  std::uint64_t missed() const noexcept { return missed_; }  ///< periods without a step
  std::uint64_t stale() const noexcept { return stale_; }    ///< steps without a new sample
  /// s, between two new samples, where no period was missed between them.
  double longest_period() const noexcept { return longest_period_; }

 private:
  bool stop(ExcitationEnd why) noexcept;
  void enter(double time, const Vec3& position, const Vec3& command) noexcept;

  runtime::Device& device_;
  ExcitationLoopSettings settings_;
  runtime::Safety safety_;
  identify::Excitation excitation_;
  identify::Frame frame_;
  identify::MotionRecord record_;
  runtime::DeviceReading reading_;
  ExcitationEnd end_ = ExcitationEnd::Running;
  std::uint64_t missed_ = 0, stale_ = 0, steps_ = 0;
  std::uint64_t missed_before_ = 0;  ///< at the last row
  double longest_period_ = 0;
  Vec3 commanded_{};                   ///< N, last, in the frame of the device
  std::int64_t start_ = 0, last_ = 0;  ///< monotonic, ns
  std::atomic<std::int64_t> heartbeat_{0};
};

}  // namespace palpate::app
