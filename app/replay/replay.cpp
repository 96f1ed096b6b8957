// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/replay/replay.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstdint>

#include "format/error.hpp"
#include "runtime/force_loop.hpp"
#include "runtime/palpate.h"
#include "runtime/safety.hpp"

namespace palpate::app {
namespace {

/// Bits that only the device can set.
constexpr std::uint32_t kOfTheDevice =
    PALPATE_LOOP_SATURATED | PALPATE_LOOP_STALE | PALPATE_LOOP_DEVICE_LOST;

runtime::ContactSettings contact_settings(const Recording& recording) {
  runtime::ContactSettings settings;
  settings.friction = recording.friction;
  settings.tank_cap = recording.settings.tank_cap;
  settings.steepness = recording.settings.steepness;
  return settings;
}

std::optional<runtime::Safety> safety_of(const SessionSettings& settings) {
  if (!settings.guarded) return {};
  return runtime::Safety(
      {settings.ramp, settings.max_force, settings.max_speed, settings.watchdog});
}

/// The step as the force loop made it, see ForceLoop::tick.
RecordedStep step_again(const RecordedStep& recorded, double dt, palpate_state& state,
                        std::optional<runtime::Safety>& safety) {
  RecordedStep step = recorded;
  step.force = {};
  if (recorded.status & PALPATE_LOOP_DEVICE_LOST && recorded.status & PALPATE_DROPPED) {
    state.contact.refuse();
  } else {
    step.status = state.step(recorded.position) | (recorded.status & kOfTheDevice);
    step.force = state.command();
    if (safety) {
      const auto verdict = safety->judge(step.force, recorded.velocity, dt);
      step.force = verdict.force;
      step.status |= verdict.status;
    }
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

Recording replay(const Recording& recorded, const palpate_library& body) {
  palpate_state state(body, contact_settings(recorded));
  state.pose.position = recorded.settings.body_position;
  std::optional<runtime::Safety> safety = safety_of(recorded.settings);
  Recording again = recorded;
  std::int64_t last = recorded.steps.empty() ? 0 : recorded.steps.front().time_ns;
  for (RecordedStep& step : again.steps) {
    const double dt = 1e-9 * static_cast<double>(step.time_ns - last);
    last = step.time_ns;
    step = step_again(step, dt, state, safety);
  }
  return again;
}

std::optional<Difference> first_difference(const Recording& recorded, const Recording& replayed) {
  for (std::size_t i = 0; i < recorded.steps.size(); ++i) {
    std::optional<Difference> found;
    any_value(recorded.steps[i], replayed.steps[i], [&](const char* what, double a, double b) {
      if (!same_bits(a, b)) found = Difference{i, what, a, b};
      return found.has_value();
    });
    if (found) return found;
  }
  return {};
}

void require_same(const Recording& recorded, const Recording& replayed, const std::string& file) {
  const auto found = first_difference(recorded, replayed);
  if (!found) return;
  const bool threaded = recorded.settings.search_rate > 0;
  throw Error(ErrorKind::Internal, fmt::format("{}, step {}", file, found->step),
              fmt::format("{} was {:.17g} and is now {:.17g}", found->what, found->recorded,
                          found->replayed),
              threaded ? "the search thread of the session may have been late there: record with "
                         "--search-rate 0 for what repeats itself to the bit"
                       : "replay with the version of palpate and on the kind of processor that "
                         "recorded it (see `palpate inspect`)");
}

}  // namespace palpate::app
