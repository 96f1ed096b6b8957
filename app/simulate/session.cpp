// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/simulate/session.hpp"

#include <chrono>
#include <cmath>
#include <memory>
#include <string>

#include "app/simulate/hand_path.hpp"
#include "app/simulate/script.hpp"
#include "format/error.hpp"
#include "format/sha256.hpp"
#include "runtime/handles.hpp"
#include "runtime/palpate.h"

namespace palpate::app {
namespace {

using LibraryHandle = std::unique_ptr<palpate_library, decltype(&palpate_library_destroy)>;
using StateHandle = std::unique_ptr<palpate_state, decltype(&palpate_state_destroy)>;

void check(int status, const std::filesystem::path& file) {
  if (status == PALPATE_OK) return;
  throw Error(ErrorKind::Configuration, file.string(), palpate_last_error(),
              palpate_status_text(status));
}

LibraryHandle load(const std::filesystem::path& file) {
  palpate_library* library = nullptr;
  check(palpate_library_load(file.c_str(), &library), file);
  return {library, &palpate_library_destroy};
}

palpate_settings chosen_settings(const SimulateSection& script, double lipschitz_bound) {
  palpate_settings settings{};
  palpate_settings_default(&settings);
  settings.tank_cap = script.tank_cap;
  settings.lipschitz_bound = lipschitz_bound;
  return settings;
}

StateHandle create(const palpate_library* library, const palpate_settings& settings,
                   const std::filesystem::path& file) {
  palpate_state* state = nullptr;
  check(palpate_state_create(library, &settings, &state), file);
  return {state, &palpate_state_destroy};
}

/// The settings of the state.
SessionSettings settings_of(const palpate_library* library, const palpate_settings& chosen) {
  const double bound = chosen.lipschitz_bound;
  SessionSettings settings;
  settings.tank_cap = chosen.tank_cap;
  settings.lipschitz_bound = bound > 0 ? bound : library->lipschitz_bound;
  return settings;
}

void observe(const palpate_state* state, RecordedStep& step) {
  palpate_observation seen{};
  seen.size = sizeof(seen);
  palpate_observe(state, &seen);
  step.contact_point = {seen.contact_point[0], seen.contact_point[1], seen.contact_point[2]};
  step.depth = seen.depth;
  step.lateral = seen.lateral;
  step.offset = seen.offset;
  step.energy = seen.energy;
  step.tank = seen.tank;
  step.absorbed = seen.absorbed;
  step.element = seen.element;
}

/// One step of the force loop, timed.
RecordedStep force_step(palpate_state* state, const runtime::SimulatedDevice& device, double dt) {
  using Clock = std::chrono::steady_clock;
  RecordedStep step;
  step.position = device.position();
  step.velocity = device.velocity();
  const auto start = Clock::now();
  step.status =
      palpate_step(state, step.position.data(), step.velocity.data(), dt, step.force.data());
  const auto spent = Clock::now() - start;
  step.latency_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(spent).count();
  observe(state, step);
  return step;
}

}  // namespace

struct ScriptedSession::State {
  State(const std::filesystem::path& file, const Library& library, const SimulateSection& given,
        double lipschitz_bound)
      : script(settled(given, library)),
        handle(load(file)),
        settings(chosen_settings(script, lipschitz_bound)),
        state(create(handle.get(), settings, file)),
        hand(scripted_path(script, library)),
        device(script.device) {
    heading.device = "simulated";
    heading.library_sha256 = sha256_of_file(file);
    heading.rate = script.rate;
    heading.friction = library.certificate.friction;
    heading.settings = settings_of(handle.get(), settings);
  }

  SimulateSection script;
  LibraryHandle handle;
  palpate_settings settings;
  StateHandle state;
  HandPath hand;
  runtime::SimulatedDevice device;
  RecordingHeading heading;
};

ScriptedSession::ScriptedSession(const std::filesystem::path& library_file, const Library& library,
                                 const SimulateSection& script, double lipschitz_bound)
    : state_(std::make_unique<State>(library_file, library, script, lipschitz_bound)) {}

ScriptedSession::~ScriptedSession() = default;

RecordingHeading ScriptedSession::heading() const {
  return state_->heading;
}

void ScriptedSession::play(const std::function<void(const RecordedStep&)>& record) {
  constexpr double kRestAfterwards = 0.2;  // s, for the device to come to rest
  State& s = *state_;
  const double dt = 1 / s.script.rate;
  const auto count =
      static_cast<std::int64_t>((s.hand.duration() + kRestAfterwards) * s.script.rate);
  s.device.place(s.hand.at(0).position, {});
  for (std::int64_t k = 0; k < count; ++k) {
    const double time = static_cast<double>(k) * dt;
    const HandState target = s.hand.at(time);
    s.device.set_target(target.position, target.velocity);
    RecordedStep step = force_step(s.state.get(), s.device, dt);
    step.time_ns = std::llround(time * 1e9);
    s.device.step(dt, step.force);
    record(step);
  }
}

}  // namespace palpate::app
