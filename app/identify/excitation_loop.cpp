// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/identify/excitation_loop.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/realtime.hpp"

namespace palpate::app {

using runtime::DeviceStatus;
using runtime::Safety;

ExcitationLoop::ExcitationLoop(runtime::Device& device, const ExcitationLoopSettings& settings)
    : device_(device),
      settings_(settings),
      safety_(settings.safety),
      excitation_(settings.excitation),
      frame_(identify::frame_along(settings.excitation.direction)) {
  const auto room =
      static_cast<std::size_t>(std::ceil(settings.excitation.seconds * settings.rate)) + 2;
  record_.time.reserve(room);
  record_.position.reserve(room);
  record_.command.reserve(room);
  record_.jump.reserve(room);
}

bool ExcitationLoop::stop(ExcitationEnd why) noexcept {
  end_ = why;
  device_.command({});
  return false;
}

bool ExcitationLoop::tick(std::int64_t) noexcept {
  const std::int64_t began = runtime::monotonic_ns();
  if (start_ == 0) start_ = began;
  const double counted = static_cast<double>(steps_++) / settings_.rate;
  const double time = settings_.counted_time ? counted : 1e-9 * static_cast<double>(began - start_);
  const double dt = last_ == 0 ? 1 / settings_.rate : 1e-9 * static_cast<double>(began - last_);
  last_ = began;
  heartbeat_.store(began, std::memory_order_relaxed);

  const DeviceStatus read = device_.read(reading_);
  if (read == DeviceStatus::Lost) return stop(ExcitationEnd::Lost);
  const bool fresh = read != DeviceStatus::Late;
  if (!fresh) ++stale_;
  const Safety::Admission admission =
      safety_.admit(reading_, fresh, settings_.counted_time ? 1 / settings_.rate : dt);
  if (admission.action == Safety::Action::Lost) return stop(ExcitationEnd::Silent);
  if (admission.action == Safety::Action::Suspend) return stop(ExcitationEnd::TooFast);
  if (time >= settings_.excitation.seconds || record_.time.size() == record_.time.capacity())
    return stop(ExcitationEnd::Done);

  if (!fresh) {  // the last command goes on, as the record says
    return device_.command(commanded_) == DeviceStatus::Lost ? stop(ExcitationEnd::Lost) : true;
  }
  const Vec3 wanted = excitation_.command(time, admission.position);
  if (excitation_.left_box()) return stop(ExcitationEnd::LeftBox);
  const Safety::Verdict verdict = safety_.limit(wanted, 0);
  const DeviceStatus done = device_.command(verdict.force);
  if (done == DeviceStatus::Lost) return stop(ExcitationEnd::Lost);
  if (done == DeviceStatus::Saturated) return stop(ExcitationEnd::Saturated);
  commanded_ = verdict.force;
  enter(time, admission.position, verdict.force);
  return true;
}

void ExcitationLoop::enter(double time, const Vec3& position, const Vec3& command) noexcept {
  if (!record_.time.empty() && missed_ == missed_before_)
    longest_period_ = std::max(longest_period_, time - record_.time.back());
  missed_before_ = missed_;
  if (excitation_.jumped()) record_.jump.push_back(record_.time.size());
  record_.time.push_back(time);
  record_.position.push_back(identify::in_frame(frame_, position));
  record_.command.push_back(identify::in_frame(frame_, command));
}

}  // namespace palpate::app
