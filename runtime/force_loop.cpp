// SPDX-License-Identifier: Apache-2.0
#include "runtime/force_loop.hpp"

#include "runtime/realtime.hpp"
#include "runtime/status.hpp"

namespace palpate::runtime {

void enter_observation(const PosedContact& contact, RecordedStep& step) noexcept {
  const ContactObservation seen = contact.observe();
  step.contact_point = seen.contact_point;
  step.depth = seen.deflection.depth;
  step.lateral = seen.lateral_distance;
  step.offset = seen.offset;
  step.energy = seen.energy;
  step.tank = seen.tank;
  step.absorbed = seen.absorbed;
  step.element = seen.point.element;
}

ForceLoop::ForceLoop(Device& device, PosedContact& contact, const SafetySettings& safety,
                     StepQueue* queue)
    : device_(device), contact_(contact), safety_(safety), queue_(queue) {}

GuardedStep guarded_step(Safety& safety, PosedContact& contact, const DeviceReading& reading,
                         bool fresh, double dt) noexcept {
  const Safety::Admission sample = safety.admit(reading, fresh, dt);
  GuardedStep step{{}, sample.status, false};
  switch (sample.action) {
    case Safety::Action::Lost:
      contact.refuse();
      step.lost = true;
      return step;
    case Safety::Action::Suspend:
      step.status |= contact.suspend(sample.position);
      break;
    case Safety::Action::Step:
      step.status |= contact.step(sample.position, dt);
      break;
  }
  // A scale that rises over a stored energy would return more than was paid.
  if (safety.ramps() && !(step.status & step_status::Contact)) contact.contact.forget();
  const double energy = safety.ramps() ? contact.contact.observation().energy : 0;
  const auto verdict = safety.limit(contact.command(), energy);
  step.status |= verdict.status;
  step.force = verdict.force;
  return step;
}

bool ForceLoop::tick(std::int64_t due, std::int64_t began) noexcept {
  heartbeat_.store(began, std::memory_order_relaxed);
  if (start_ == 0) start_ = last_ = began;
  const double dt = 1e-9 * static_cast<double>(began - last_);
  last_ = began;
  counts_.wake.add(began - due);

  DeviceReading reading;
  const DeviceStatus sample = device_.read(reading);
  GuardedStep step;
  if (sample == DeviceStatus::Lost) {
    contact_.refuse();
    step.lost = true;
  } else {
    step = guarded_step(safety_, contact_, reading, sample != DeviceStatus::Late, dt);
    counts_.silent = step.lost;
  }
  step.status |= note(step.lost ? DeviceStatus::Lost : sample);
  if (step.lost) step.status |= step_status::Dropped;
  const DeviceStatus given = device_.command(step.force);
  // A late answer to the command was counted with its sample.
  if (!step.lost && given != DeviceStatus::Late) step.status |= note(given);
  count(step.status);
  record(reading, step.force, step.status, began);
  return !counts_.lost;
}

std::uint32_t ForceLoop::note(DeviceStatus status) noexcept {
  switch (status) {
    case DeviceStatus::Good:
      return 0;
    case DeviceStatus::Saturated:
      ++counts_.saturated;
      return step_status::LoopSaturated;
    case DeviceStatus::Late:
      ++counts_.stale;
      return step_status::LoopStale;
    case DeviceStatus::Lost:
      break;
  }
  counts_.lost = true;
  return step_status::LoopDeviceLost;
}

void ForceLoop::count(std::uint32_t status) noexcept {
  const auto one_if = [status](std::uint32_t bits) { return (status & bits) != 0 ? 1U : 0U; };
  counts_.late += one_if(step_status::LoopLate);
  counts_.clamped += one_if(step_status::LoopClamped);
  counts_.cut_off +=
      one_if(step_status::LoopLate | step_status::LoopTooFast | step_status::LoopOutdated);
  counts_.outdated += one_if(step_status::LoopOutdated);
  counts_.rejected += one_if(step_status::LoopRejected);
  counts_.not_finite += one_if(step_status::LoopNotFinite);
}

void ForceLoop::record(const DeviceReading& reading, const Vec3& force, std::uint32_t status,
                       std::int64_t began) noexcept {
  const std::int64_t spent = monotonic_ns() - began;
  counts_.compute.add(spent);
  ++counts_.steps;
  if (queue_ == nullptr) return;
  RecordedStep step;
  step.time_ns = began - start_;
  step.position = reading.position;
  step.velocity = reading.velocity;
  step.force = force;
  enter_observation(contact_, step);
  step.status = status;
  step.latency_ns = spent;
  if (!queue_->try_enqueue(step)) ++counts_.unrecorded;
}

}  // namespace palpate::runtime
