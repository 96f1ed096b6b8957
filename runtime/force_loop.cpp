// SPDX-License-Identifier: Apache-2.0
#include "runtime/force_loop.hpp"

#include "runtime/realtime.hpp"
#include "runtime/status.hpp"

namespace palpate::runtime {

void enter_observation(const PosedContact& contact, RecordedStep& step) noexcept {
  const ContactObservation seen = contact.observe();
  step.contact_point = seen.contact_point;
  step.depth = seen.deflection.depth;
  step.lateral = seen.deflection.lateral;
  step.offset = seen.offset;
  step.energy = seen.energy;
  step.tank = seen.tank;
  step.absorbed = seen.absorbed;
  step.element = seen.point.element;
}

ForceLoop::ForceLoop(Device& device, PosedContact& contact, const SafetySettings& safety,
                     StepQueue* queue)
    : device_(device), contact_(contact), safety_(safety), queue_(queue) {}

bool ForceLoop::tick(std::int64_t due) noexcept {
  const std::int64_t began = monotonic_ns();
  heartbeat_.store(began, std::memory_order_relaxed);
  if (start_ == 0) start_ = last_ = began;
  const double dt = 1e-9 * static_cast<double>(began - last_);
  last_ = began;
  counts_.wake.add(began - due);

  DeviceReading reading;
  std::uint32_t status = note(device_.read(reading));
  if (counts_.lost) {
    contact_.contact.refuse();
    record(reading, {}, status | step_status::Dropped, began);
    return false;
  }
  status |= contact_.step(reading.position);
  const auto verdict = safety_.judge(contact_.command(), reading.velocity, dt);
  status |= verdict.status | note(device_.command(verdict.force));
  count(status);
  record(reading, verdict.force, status, began);
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
  counts_.cut_off += one_if(step_status::LoopLate | step_status::LoopTooFast);
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
