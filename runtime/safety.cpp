// SPDX-License-Identifier: Apache-2.0
#include "runtime/safety.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "runtime/settings_check.hpp"
#include "runtime/status.hpp"

namespace palpate::runtime {
namespace {

/// Periods for which a device may repeat a position before the next counts from the last step: a
/// driver that is slower than the loop repeats it without saying so.
constexpr double kRepeats = 3;
/// J; a contact that stores less may be scaled anew.
constexpr double kNoEnergy = 1e-12;

}  // namespace

Safety::Safety(const SafetySettings& settings) : settings_(settings) {
  const SettingsCheck require("safety of the force loop");
  require(std::isfinite(settings.period) && settings.period > 0, "rate (Hz)", 1 / settings.period,
          "a finite value above 0");
  require(std::isfinite(settings.ramp) && settings.ramp >= 0, "ramp (s)", settings.ramp,
          "0 or more, finite");
  require(settings.max_force > 0, "max_force (N)", settings.max_force, "a value above 0");
  require(settings.max_speed > 0, "max_speed (m/s)", settings.max_speed, "a value above 0");
  require(settings.watchdog > 0, "watchdog (s)", settings.watchdog, "a value above 0");
}

Safety::Admission Safety::admit(const DeviceReading& reading, bool fresh, double dt) noexcept {
  Admission admission;
  dt_ = std::isfinite(dt) ? dt : settings_.watchdog;
  since_motion_ += dt_;
  const double age = age_ + std::min(dt_, settings_.watchdog);  // a stall is no silence
  const bool was_rejected = rejected_;
  const Vec3 before = accepted_.value_or(reading.position);
  const bool accepted = fresh && accept(reading.position, admission.status);
  age_ = accepted ? 0 : age;
  const bool far = norm(reading.position - before) > 2 * settings_.max_speed * settings_.period;
  if (!(dt <= settings_.watchdog)) admission.status |= step_status::LoopLate;
  if (too_fast(reading.velocity) || (accepted && was_rejected && far))
    admission.status |= step_status::LoopTooFast;
  if (age > settings_.watchdog) admission.status |= step_status::LoopOutdated;
  suspended_ = (admission.status & (step_status::LoopLate | step_status::LoopTooFast)) != 0 ||
               (accepted && age > settings_.watchdog);
  if (suspended_) admission.action = Action::Suspend;
  if (age_ > kSilentLimits * settings_.watchdog) admission.action = Action::Lost;
  const bool usable = is_finite(reading.position) && accepted_;
  admission.position = usable ? *accepted_ : reading.position;
  return admission;
}

/// Can the tip have come here since the last accepted sample?
bool Safety::accept(const Vec3& position, std::uint32_t& status) noexcept {
  if (!is_finite(position)) return false;
  const double window = std::max(since_motion_, settings_.period);
  const double path = accepted_ ? norm(position - *accepted_) : 0;
  rejected_ = path > settings_.max_speed * (window + settings_.period);
  if (rejected_) {
    status |= step_status::LoopRejected;
    return false;
  }
  speed_ = path / window;
  since_motion_ = path > 0 ? 0 : std::min(since_motion_, kRepeats * settings_.period);
  accepted_ = position;
  return true;
}

bool Safety::too_fast(const Vec3& velocity) noexcept {
  const double limit = too_fast_ ? settings_.max_speed / 2 : settings_.max_speed;
  too_fast_ = !(norm(velocity) <= limit && speed_ <= limit);
  return too_fast_;
}

Safety::Verdict Safety::limit(const Vec3& force, double energy) noexcept {
  Verdict verdict;
  if (suspended_) return verdict;
  double scale = fade() * ramp(energy, verdict.status);
  if (!is_finite(force)) {
    verdict.status = (verdict.status & ~step_status::LoopRamping) | step_status::LoopNotFinite;
    return verdict;
  }
  const double size = scale * norm(force);
  if (size > settings_.max_force) {
    scale *= settings_.max_force / size;
    verdict.status |= step_status::LoopClamped;
  }
  verdict.force = scale * force;
  return verdict;
}

double Safety::ramp(double energy, std::uint32_t& status) noexcept {
  if (energy <= kNoEnergy) ramped_ = std::min(ramped_ + dt_, settings_.ramp);
  if (!ramps()) return 1;
  status |= step_status::LoopRamping;
  return ramped_ / settings_.ramp;
}

double Safety::fade() const noexcept {
  return std::clamp(2 - age_ / settings_.watchdog, 0.0, 1.0);
}

}  // namespace palpate::runtime
