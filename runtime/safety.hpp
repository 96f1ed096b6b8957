// SPDX-License-Identifier: Apache-2.0
// The safety functions that a force passes before it reaches a hand.
#pragma once

#include <cstdint>
#include <limits>

#include "format/vec3.hpp"

namespace palpate::runtime {

struct SafetySettings {
  double ramp = 0.5;  ///< s, time of the force ramp, at the start and after each cut-off
  double max_force = std::numeric_limits<double>::infinity();  ///< N
  double max_speed = 3;    ///< m/s; above it the force is cut off
  double watchdog = 0.02;  ///< s; a longer time between two steps cuts the force off
};

/// Turns the force of the body into the commanded force, in this order: a tip that is too fast or a
/// step that is too late cuts the force off and restarts the ramp; a force that is not finite
/// becomes zero; the ramp scales; the clamp shortens and keeps the direction. A cut-off by speed
/// lasts until the speed is below half of the limit. Clamp and ramp are not covered by the
/// certificate: each action is reported in the status. noexcept, allocation-free.
class Safety {
 public:
  /// @throws Error(Configuration) naming the setting that is out of range.
  explicit Safety(const SafetySettings& settings);

  struct Verdict {
    Vec3 force{};              ///< N
    std::uint32_t status = 0;  ///< step_status::Loop* bits
  };
  /// dt: s since the last step.
  Verdict judge(const Vec3& force, const Vec3& velocity, double dt) noexcept;

 private:
  bool cut_off(const Vec3& velocity, double dt, std::uint32_t& status) noexcept;

  SafetySettings settings_;
  double since_cut_ = 0;  ///< s
  bool too_fast_ = false;
};

}  // namespace palpate::runtime
