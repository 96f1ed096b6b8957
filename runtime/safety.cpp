// SPDX-License-Identifier: Apache-2.0
#include "runtime/safety.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "runtime/settings_check.hpp"
#include "runtime/status.hpp"

namespace palpate::runtime {

Safety::Safety(const SafetySettings& settings) : settings_(settings) {
  const SettingsCheck require("safety of the force loop");
  require(std::isfinite(settings.ramp) && settings.ramp >= 0, "ramp (s)", settings.ramp,
          "0 or more, finite");
  require(settings.max_force > 0, "max_force (N)", settings.max_force, "a value above 0");
  require(settings.max_speed > 0, "max_speed (m/s)", settings.max_speed, "a value above 0");
  require(settings.watchdog > 0, "watchdog (s)", settings.watchdog, "a value above 0");
}

bool Safety::cut_off(const Vec3& velocity, double dt, std::uint32_t& status) noexcept {
  const double speed = norm(velocity);
  too_fast_ = !(speed <= (too_fast_ ? settings_.max_speed / 2 : settings_.max_speed));
  const bool late = !(dt <= settings_.watchdog);
  if (too_fast_) status |= step_status::LoopTooFast;
  if (late) status |= step_status::LoopLate;
  return too_fast_ || late;
}

Safety::Verdict Safety::judge(const Vec3& force, const Vec3& velocity, double dt) noexcept {
  Verdict verdict;
  if (cut_off(velocity, dt, verdict.status)) {
    since_cut_ = 0;
    return verdict;
  }
  since_cut_ = std::min(since_cut_ + dt, settings_.ramp);
  if (!is_finite(force)) {
    verdict.status |= step_status::LoopNotFinite;
    return verdict;
  }
  double scale = 1;
  if (since_cut_ < settings_.ramp) {
    scale = since_cut_ / settings_.ramp;
    verdict.status |= step_status::LoopRamping;
  }
  const double size = scale * norm(force);
  if (size > settings_.max_force) {
    scale *= settings_.max_force / size;
    verdict.status |= step_status::LoopClamped;
  }
  verdict.force = scale * force;
  return verdict;
}

}  // namespace palpate::runtime
