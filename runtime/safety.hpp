// SPDX-License-Identifier: Apache-2.0
// The safety functions between the samples of a device, the force of the body and a hand.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "format/vec3.hpp"
#include "runtime/device.hpp"

namespace palpate::runtime {

/// Periods of the loop without a step, or without a new sample, after which the force is cut off,
/// where no time is given.
inline constexpr double kWatchdogPeriods = 20;
/// Watchdog limits without a new sample after which the device counts as lost.
inline constexpr double kSilentLimits = 50;

/// Watchdog limit at this rate (Hz) where none is given, s.
constexpr double default_watchdog(double rate) noexcept {
  return kWatchdogPeriods / rate;
}

struct SafetySettings {
  double ramp = 0.5;  ///< s, time of the force ramp at the start
  double max_force = std::numeric_limits<double>::infinity();  ///< N
  double max_speed = 3;  ///< m/s; above it the force is cut off
  /// s; a longer time between two steps cuts the force off, a longer time without a new sample
  /// ends it
  double watchdog = default_watchdog(1000);
  double period = 1e-3;  ///< s, between two steps of the loop
};

/// Decides in each step whether the sample of the device can be used, and turns the force of the
/// body into the commanded force. admit(), then the step of the contact, then limit().
///
/// Samples. A sample that is farther from the last accepted one than a tip of max_speed can travel
/// in the time between them, plus one period, is rejected: the last one is used again. Without an
/// accepted new sample for longer than the watchdog limit T_w the force falls in a straight line,
/// to zero at 2 T_w; after 50 T_w the device is lost.
///
/// Cut-offs. A tip that is too fast, by the velocity that the device reports or by the difference
/// of its positions, until it is below half of max_speed; a step later than T_w; the first new
/// sample after T_w without one; and the first sample that is accepted far away after rejected
/// ones. In these steps there is no force and the contact is suspended: its stored energy is
/// discarded, and it begins again at the position of the next step, without force and energy.
///
/// Forces. One that is not finite becomes zero; the ramp scales, and its scale rises only while the
/// contact stores no energy, so that it returns none; the clamp shortens and keeps the direction.
/// Clamp and ramp are not covered by the certificate: each action is reported in the status.
///
/// noexcept, allocation-free. One thread at a time.
class Safety {
 public:
  /// @throws Error(Configuration) naming the setting that is out of range.
  explicit Safety(const SafetySettings& settings);

  enum class Action : std::uint8_t {
    Step,     ///< the contact makes a step
    Suspend,  ///< no force; the contact is suspended
    Lost      ///< no new sample for too long: the loop ends
  };
  struct Admission {
    Action action = Action::Step;
    Vec3 position{};           ///< m, for the contact
    std::uint32_t status = 0;  ///< step_status::Loop* bits
  };
  struct Verdict {
    Vec3 force{};              ///< N
    std::uint32_t status = 0;  ///< step_status::Loop* bits
  };

  /// fresh: the sample is new; dt: s since the last step.
  Admission admit(const DeviceReading& reading, bool fresh, double dt) noexcept;
  /// energy: stored in the contact after the step, J; of no effect unless ramps().
  Verdict limit(const Vec3& force, double energy) noexcept;
  /// Whether the force is still scaled by the ramp at the start.
  bool ramps() const noexcept { return ramped_ < settings_.ramp; }

 private:
  bool accept(const Vec3& position, std::uint32_t& status) noexcept;
  bool too_fast(const Vec3& velocity) noexcept;
  double ramp(double energy, std::uint32_t& status) noexcept;
  double fade() const noexcept;

  SafetySettings settings_;
  std::optional<Vec3> accepted_;  ///< position of the last accepted sample, m
  double speed_ = 0;              ///< m/s, by the last two accepted positions
  double age_ = 0;                ///< s without an accepted new sample
  double since_motion_ = 0;       ///< s since the accepted position changed
  double dt_ = 0;                 ///< s, of this step
  double ramped_ = 0;             ///< s, of the ramp
  bool rejected_ = false;         ///< the last new sample
  bool too_fast_ = false, suspended_ = false;
};

}  // namespace palpate::runtime
