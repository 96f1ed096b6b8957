// SPDX-License-Identifier: Apache-2.0
// The force loop of the C interface.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "format/error.hpp"
#include "runtime/c_boundary.hpp"
#include "runtime/certified_state.hpp"
#include "runtime/force_loop.hpp"
#include "runtime/handles.hpp"
#include "runtime/loop_thread.hpp"
#include "runtime/palpate.h"

namespace {

using palpate::Vec3;
using palpate::runtime::copy;
using palpate::runtime::DeviceReading;
using palpate::runtime::DeviceStatus;

/// The caller's functions as a device.
class CallerDevice : public palpate::runtime::Device {
 public:
  explicit CallerDevice(const palpate_device& functions) : functions_(functions) {}

  std::string name() const override { return "device of the embedding program"; }
  void open() override {}
  void close() noexcept override {}
  DeviceStatus read(DeviceReading& reading) noexcept override {
    const int result =
        functions_.read(functions_.context, reading.position.data(), reading.velocity.data());
    if (result < 0) return DeviceStatus::Lost;
    return result == 0 ? DeviceStatus::Good : DeviceStatus::Late;
  }
  DeviceStatus command(const Vec3& force) noexcept override {
    const Vec3 given = halted_ ? Vec3{} : force;
    const int result = functions_.command(functions_.context, given.data());
    if (result < 0) return DeviceStatus::Lost;
    return result == 0 ? DeviceStatus::Good : DeviceStatus::Saturated;
  }
  void halt() noexcept override {
    halted_ = true;
    if (functions_.halt != nullptr) functions_.halt(functions_.context);
  }

 private:
  palpate_device functions_;
  std::atomic<bool> halted_{false};
};

double watchdog_of(const palpate_loop_settings& s) {
  return s.watchdog == 0 ? palpate::runtime::default_watchdog(s.rate) : s.watchdog;
}

palpate::runtime::SafetySettings safety_of(const palpate_loop_settings& s,
                                           const palpate_device& device) {
  const bool by_device = std::isinf(s.max_force) && device.continuous_force > 0;
  const double max_force = by_device ? device.continuous_force : s.max_force;
  return {s.ramp, max_force, s.max_speed, watchdog_of(s), 1 / s.rate};
}

palpate::runtime::LoopThreadSettings thread_of(const palpate_loop_settings& s) {
  palpate::runtime::LoopThreadSettings thread{s.rate, watchdog_of(s), {s.priority, s.core}};
  thread.wake_early = s.wake_early;
  return thread;
}

}  // namespace

/// A state while a loop steps it. @throws Error(Configuration) where another one does.
class OwnedState {
 public:
  explicit OwnedState(palpate_state& state) : state_(state) {
    if (state_.in_loop.exchange(true))
      throw palpate::Error(palpate::ErrorKind::Configuration, "palpate_loop_start",
                           "the state belongs to a loop that has not been stopped",
                           "stop that loop, or create another state");
  }
  ~OwnedState() { state_.in_loop = false; }
  OwnedState(const OwnedState&) = delete;
  OwnedState& operator=(const OwnedState&) = delete;

 private:
  palpate_state& state_;
};

struct palpate_loop {
  palpate_loop(palpate_state& state, const palpate_device& functions,
               const palpate_loop_settings& settings, std::string why_not_certified)
      : not_certified(std::move(why_not_certified)),
        device(functions),
        owned(state),
        loop(device, state, safety_of(settings, functions), queue_of(settings)),
        thread(loop, device, thread_of(settings)) {}

 private:
  palpate::runtime::StepQueue* queue_of(const palpate_loop_settings& settings) {
    return settings.record == 0 ? nullptr : &record.emplace(settings.record);
  }

 public:
  std::string not_certified;  ///< why; empty: it is certified
  CallerDevice device;
  std::optional<palpate::runtime::StepQueue> record;
  OwnedState owned;
  palpate::runtime::ForceLoop loop;
  palpate::runtime::LoopThread thread;
};

namespace {

// Smallest valid sizes of the structs.
constexpr std::uint32_t kFirstLoopSettings = offsetof(palpate_loop_settings, record);
constexpr std::uint32_t kFirstDevice = offsetof(palpate_device, continuous_force);
constexpr std::uint32_t kFirstReport = offsetof(palpate_loop_report, unrecorded);
constexpr std::uint32_t kFirstStep = sizeof(palpate_loop_step);

palpate_loop_step translate(const palpate::RecordedStep& recorded) noexcept {
  palpate_loop_step step{};
  step.status = recorded.status;
  step.element = recorded.element;
  step.time_ns = recorded.time_ns;
  step.spent_ns = recorded.latency_ns;
  copy(recorded.position, step.position);
  copy(recorded.velocity, step.velocity);
  copy(recorded.force, step.force);
  copy(recorded.contact_point, step.contact_point);
  step.depth = recorded.depth;
  step.lateral = recorded.lateral;
  step.offset = recorded.offset;
  step.energy = recorded.energy;
  step.tank = recorded.tank;
  step.absorbed = recorded.absorbed;
  return step;
}

/// Why the loop is not certified passive; empty when it is.
std::string why_not_certified(const palpate_state& state, const palpate_loop_settings& settings) {
  palpate_device_constants constants;
  palpate_device_constants_default(&constants);
  if (settings.constants != nullptr) {
    if (settings.constants->size < sizeof constants) {
      throw palpate::Error(palpate::ErrorKind::Configuration, "palpate_loop_start",
                           "the constants of the device have no size",
                           "fill them with palpate_device_constants_default first");
    }
    constants = *settings.constants;
  }
  return palpate::runtime::why_not_certified(
      state,
      {constants.damping, constants.coulomb_friction, constants.delay,
       constants.position_resolution, constants.force_resolution},
      settings.rate);
}

palpate_loop_report report_on(const palpate_loop& loop) {
  constexpr double kNanosecond = 1e-9;
  const palpate::runtime::LoopCounts& c = loop.loop.counts();
  palpate_loop_report report{};
  report.lost = c.lost ? 1 : 0;
  report.halted = loop.thread.halted() ? 1 : 0;
  report.steps = c.steps;
  report.overruns = c.overruns;
  report.late = c.late;
  report.cut_off = c.cut_off;
  report.clamped = c.clamped;
  report.saturated = c.saturated;
  report.stale = c.stale;
  report.not_finite = c.not_finite;
  report.wake_median = kNanosecond * c.wake.quantile(0.5);
  report.wake_p999 = kNanosecond * c.wake.quantile(0.999);
  report.wake_longest = kNanosecond * static_cast<double>(c.wake.largest());
  report.compute_median = kNanosecond * c.compute.quantile(0.5);
  report.compute_p999 = kNanosecond * c.compute.quantile(0.999);
  report.compute_longest = kNanosecond * static_cast<double>(c.compute.largest());
  const std::string missing = loop.thread.missing_rights();
  std::strncpy(report.missing_rights, missing.c_str(), sizeof report.missing_rights - 1);
  report.unrecorded = c.unrecorded;
  report.outdated = c.outdated;
  report.rejected = c.rejected;
  report.silent = c.silent ? 1 : 0;
  report.certified = loop.not_certified.empty() ? 1 : 0;
  return report;
}

}  // namespace

extern "C" {

void palpate_loop_settings_default(palpate_loop_settings* settings) {
  if (settings == nullptr) return;
  const palpate::runtime::SafetySettings safety;
  const palpate::runtime::LoopThreadSettings thread;
  *settings = {sizeof(palpate_loop_settings),
               thread.realtime.priority,
               thread.realtime.core,
               thread.rate,
               safety.ramp,
               safety.max_force,
               safety.max_speed,
               0,
               0,
               nullptr,
               0,
               thread.wake_early};
}

int palpate_loop_start(palpate_state* state, const palpate_device* device,
                       const palpate_loop_settings* settings, palpate_loop** loop) {
  using palpate::runtime::fail;
  if (loop == nullptr) return fail(PALPATE_ERROR_ARGUMENT, "palpate_loop_start: loop is null");
  *loop = nullptr;
  if (state == nullptr || device == nullptr)
    return fail(PALPATE_ERROR_ARGUMENT, "palpate_loop_start: null pointer");
  if (device->size < kFirstDevice || device->read == nullptr || device->command == nullptr) {
    return fail(PALPATE_ERROR_ARGUMENT,
                "palpate_loop_start: the device needs its size, read and command");
  }
  palpate_device reached{};
  palpate::runtime::give(*device, &reached, device->size);
  palpate_loop_settings chosen;
  palpate_loop_settings_default(&chosen);
  if (settings != nullptr) {
    if (settings->size < kFirstLoopSettings) {
      return fail(PALPATE_ERROR_ARGUMENT,
                  "palpate_loop_start: fill the settings with palpate_loop_settings_default first");
    }
    palpate::runtime::give(*settings, &chosen, settings->size);
  }
  return palpate::runtime::guarded(PALPATE_ERROR_ARGUMENT, [&] {
    std::string reason = why_not_certified(*state, chosen);
    if (!reason.empty() && chosen.constants != nullptr && chosen.uncertified == 0)
      return fail(PALPATE_ERROR_UNCERTIFIED, ("palpate_loop_start: " + reason).c_str());
    *loop = new palpate_loop(*state, reached, chosen, std::move(reason));
    return static_cast<int>(PALPATE_OK);
  });
}

int palpate_loop_certified(const palpate_loop* loop) {
  using palpate::runtime::fail;
  if (loop == nullptr) return fail(PALPATE_ERROR_ARGUMENT, "palpate_loop_certified: loop is null");
  return loop->not_certified.empty() ? 1 : fail(0, loop->not_certified.c_str());
}

int palpate_loop_running(const palpate_loop* loop) {
  return loop != nullptr && loop->thread.running() ? 1 : 0;
}

int palpate_loop_take(palpate_loop* loop, palpate_loop_step* step) {
  if (loop == nullptr || step == nullptr || step->size < kFirstStep || !loop->record) return 0;
  palpate::RecordedStep recorded;
  if (!loop->record->try_dequeue(recorded)) return 0;
  palpate::runtime::give(translate(recorded), step, step->size);
  return 1;
}

void palpate_loop_end(palpate_loop* loop) {
  if (loop != nullptr) loop->thread.stop();
}

int palpate_loop_stop(palpate_loop* loop, palpate_loop_report* report) {
  using palpate::runtime::fail;
  if (loop == nullptr) return fail(PALPATE_ERROR_ARGUMENT, "palpate_loop_stop: loop is null");
  if (report != nullptr && report->size < kFirstReport)
    return fail(PALPATE_ERROR_ARGUMENT, "palpate_loop_stop: set report->size to sizeof");
  loop->thread.stop();
  const int status = palpate::runtime::guarded(PALPATE_ERROR_MEMORY, [&] {
    if (report != nullptr) palpate::runtime::give(report_on(*loop), report, report->size);
    return static_cast<int>(PALPATE_OK);
  });
  delete loop;
  return status;
}

}  // extern "C"
