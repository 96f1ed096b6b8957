// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/replay/replay.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstdint>

#include "format/error.hpp"
#include "runtime/force_loop.hpp"
#include "runtime/palpate.h"

namespace palpate::app {
namespace {

/// Bits that only the device can set.
constexpr std::uint32_t kOfTheDevice =
    PALPATE_LOOP_SATURATED | PALPATE_LOOP_STALE | PALPATE_LOOP_DEVICE_LOST;

runtime::ContactSettings contact_settings(const RecordingHeading& recording) {
  runtime::ContactSettings settings;
  settings.friction = recording.friction;
  settings.tank_cap = recording.settings.tank_cap;
  settings.lipschitz_bound = recording.settings.lipschitz_bound;
  return settings;
}

std::optional<runtime::Safety> safety_of(const RecordingHeading& recording) {
  const SessionSettings& settings = recording.settings;
  if (!settings.guarded) return {};
  runtime::SafetySettings safety{settings.ramp, settings.max_force, settings.max_speed,
                                 settings.watchdog};
  if (recording.rate > 0) safety.period = 1 / recording.rate;
  return runtime::Safety(safety);
}

/// The step as the force loop made it, see ForceLoop::tick.
RecordedStep step_again(const RecordedStep& recorded, double dt, palpate_state& state,
                        std::optional<runtime::Safety>& safety) {
  RecordedStep step = recorded;
  step.force = {};
  if (recorded.status & PALPATE_LOOP_DEVICE_LOST && recorded.status & PALPATE_DROPPED) {
    state.refuse();
  } else if (safety) {
    const bool fresh = (recorded.status & PALPATE_LOOP_STALE) == 0;
    const runtime::GuardedStep guarded =
        runtime::guarded_step(*safety, state, {recorded.position, recorded.velocity, 0}, fresh, dt);
    step.force = guarded.force;
    step.status = guarded.status | (recorded.status & kOfTheDevice);
  } else {
    step.status = state.step(recorded.position, dt) | (recorded.status & kOfTheDevice);
    step.force = state.command();
  }
  runtime::enter_observation(state, step);
  return step;
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// Calls visit(name, value) for what the model gave, until it returns true.
template <class Visit>
bool any_value(const RecordedStep& a, const RecordedStep& b, Visit&& visit) {
  constexpr const char* kForce[3] = {"force[0]", "force[1]", "force[2]"};
  constexpr const char* kPoint[3] = {"contact_point[0]", "contact_point[1]", "contact_point[2]"};
  for (std::size_t i = 0; i < 3; ++i)
    if (visit(kForce[i], a.force[i], b.force[i]) ||
        visit(kPoint[i], a.contact_point[i], b.contact_point[i]))
      return true;
  return visit("depth", a.depth, b.depth) || visit("lateral", a.lateral, b.lateral) ||
         visit("offset", a.offset, b.offset) || visit("energy", a.energy, b.energy) ||
         visit("tank", a.tank, b.tank) || visit("absorbed", a.absorbed, b.absorbed) ||
         visit("element", a.element, b.element) || visit("status", a.status, b.status);
}

}  // namespace

Replay::Replay(const RecordingHeading& recorded, const palpate_library& body)
    : state_(body, contact_settings(recorded)), safety_(safety_of(recorded)) {
  state_.pose.position = recorded.settings.body_position;
  if (recorded.rate > 0) period_ = 1 / recorded.rate;
}

RecordedStep Replay::step(const RecordedStep& recorded) {
  const double since =
      1e-9 * static_cast<double>(recorded.time_ns - last_.value_or(recorded.time_ns));
  const double dt = safety_ ? since : period_;
  last_ = recorded.time_ns;
  return step_again(recorded, dt, state_, safety_);
}

Recording replay(const Recording& recorded, const palpate_library& body) {
  Replay model(recorded, body);
  Recording again = recorded;
  for (RecordedStep& step : again.steps) step = model.step(step);
  return again;
}

std::optional<Difference> difference(const RecordedStep& recorded, const RecordedStep& replayed,
                                     std::size_t number) {
  std::optional<Difference> found;
  any_value(recorded, replayed, [&](const char* what, double a, double b) {
    if (!same_bits(a, b)) found = Difference{number, what, a, b};
    return found.has_value();
  });
  return found;
}

std::optional<Difference> first_difference(const Recording& recorded, const Recording& replayed) {
  for (std::size_t i = 0; i < recorded.steps.size(); ++i) {
    auto found = difference(recorded.steps[i], replayed.steps[i], i);
    if (found) return found;
  }
  return {};
}

void refuse_difference(const Difference& found, const RecordingHeading& recorded,
                       const std::string& file) {
  const bool threaded = recorded.settings.search_rate > 0;
  throw Error(
      ErrorKind::Internal, fmt::format("{}, step {}", file, found.step),
      fmt::format("{} was {:.17g} and is now {:.17g}", found.what, found.recorded, found.replayed),
      threaded ? "the search thread of the session may have been late there: record with "
                 "--search-rate 0 for what repeats itself to the bit"
               : "replay with the version of palpate and on the kind of processor that "
                 "recorded it (see `palpate inspect`)");
}

}  // namespace palpate::app
