// SPDX-License-Identifier: Apache-2.0
// The last word on a force before it reaches a hand.
#pragma once

#include <cstdint>
#include <limits>

#include "format/vec3.hpp"

namespace palpate::runtime {

struct SafetySettings {
  double ramp = 0.5;  ///< s, from no force to full force, at the start and after each cut-off
  double max_force = std::numeric_limits<double>::infinity();  ///< N
  double max_speed = 3;    ///< m/s; faster than this the force is cut off
  double watchdog = 0.02;  ///< s; a longer gap between two steps cuts the force off
};

/// Turns the force of the body into the force that is commanded, in this order: what is not finite
/// becomes zero; too fast or too late cuts off, and the ramp begins anew; the ramp scales; the
/// clamp shortens and keeps the direction. A cut-off by speed lasts until the speed is below half
/// of the limit. Clamp and ramp are no part of the passive model: they are reported, and meant not
/// to act. noexcept, allocation-free.
class Safety {
 public:
  /// @throws Error(Configuration) naming the setting that is out of range.
  explicit Safety(const SafetySettings& settings);

  struct Verdict {
    Vec3 force{};              ///< N
    std::uint32_t status = 0;  ///< bits of palpate.h, PALPATE_LOOP_*
  };
  /// dt: s since the step before.
  Verdict judge(const Vec3& force, const Vec3& velocity, double dt) noexcept;

 private:
  bool cut_off(const Vec3& velocity, double dt, std::uint32_t& status) noexcept;

  SafetySettings settings_;
  double since_cut_ = 0;  ///< s
  bool too_fast_ = false;
};

}  // namespace palpate::runtime
