// SPDX-License-Identifier: AGPL-3.0-or-later
// The force loop of the C interface.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <thread>
#include <vector>

#include "runtime/handles.hpp"
#include "runtime/palpate.h"
#include "tests/support/bodies.hpp"
#include "tests/unit/runtime/api_fixture.hpp"

namespace palpate::test {
namespace {

using PalpateLoop = PalpateApi;

/// A device of the embedding program: presses slowly, counts, and may vanish.
struct OwnDevice {
  static int read(void* self, double position[3], double velocity[3]) {
    auto& d = *static_cast<OwnDevice*>(self);
    position[0] = 0.03, position[1] = 0.033, position[2] = 0.0005 - 2e-5 * d.reads;
    velocity[0] = velocity[1] = 0, velocity[2] = -0.02;
    return ++d.reads > d.lasts ? -1 : 0;
  }
  static int command(void* self, const double force[3]) {
    auto& d = *static_cast<OwnDevice*>(self);
    d.largest = std::max(d.largest, std::abs(force[2]));
    d.last = std::abs(force[2]);
    return 0;
  }
  palpate_device functions() { return {sizeof(palpate_device), this, read, command, nullptr, 0}; }
  int reads = 0, lasts = 150;
  double largest = 0, last = 1;
};

/// A loop at the ordinary priority.
palpate_loop_settings settings_at(double rate) {
  palpate_loop_settings settings;
  palpate_loop_settings_default(&settings);
  settings.priority = 0;
  settings.rate = rate;
  return settings;
}

/// Without ramp, and with a watchdog that a busy machine does not wake.
palpate_loop_settings patient_settings() {
  palpate_loop_settings settings = settings_at(2000);
  settings.ramp = 0;
  settings.watchdog = 10;
  return settings;
}

/// Until the device is lost, at most ten seconds.
void wait_for_end(palpate_loop* loop) {
  for (int i = 0; i < 10000 && palpate_loop_running(loop); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST_F(PalpateLoop, RunsUntilTheDeviceIsLost) {
  OwnDevice own;
  const palpate_device device = own.functions();
  palpate_loop_settings settings = patient_settings();
  palpate_loop* loop = nullptr;
  ASSERT_EQ(palpate_loop_start(state_, &device, &settings, &loop), PALPATE_OK)
      << palpate_last_error();
  wait_for_end(loop);
  palpate_loop_report report{};
  report.size = sizeof report;
  EXPECT_EQ(palpate_loop_stop(loop, &report), PALPATE_OK);
  EXPECT_EQ(report.lost, 1U);
  EXPECT_EQ(report.halted, 0U);
  EXPECT_EQ(report.steps, 151U);
  EXPECT_GT(report.compute_median, 0);
  EXPECT_GE(report.wake_p999, report.wake_median);
  // A quantile of the histogram is the upper end of its bin.
  EXPECT_LE(report.wake_p999, 2 * report.wake_longest);
  EXPECT_GE(report.compute_longest, report.compute_median);
  // 100 k z^2 at the last position before it was lost, less the offset of one step.
  EXPECT_NEAR(own.largest, 100 * kStiffness * std::pow(0.0005 - 2e-5 * 149 + 2e-5, 2), 2e-3);
  EXPECT_EQ(own.last, 0);
}

/// The steps of a loop over this device until it is lost; `room`: for its record.
struct RecordedLoop {
  RecordedLoop(palpate_state* state, std::uint32_t room) {
    OwnDevice own;
    const palpate_device device = own.functions();
    palpate_loop_settings settings = patient_settings();
    EXPECT_EQ(settings.record, 0U);
    settings.record = room;
    palpate_loop* loop = nullptr;
    EXPECT_EQ(palpate_loop_start(state, &device, &settings, &loop), PALPATE_OK);
    wait_for_end(loop);
    palpate_loop_end(loop);
    palpate_loop_step step{};
    EXPECT_EQ(palpate_loop_take(loop, &step), 0);  // its size is not set
    step.size = sizeof step;
    while (palpate_loop_take(loop, &step) == 1) steps.push_back(step);
    report.size = sizeof report;
    EXPECT_EQ(palpate_loop_stop(loop, &report), PALPATE_OK);
  }
  std::vector<palpate_loop_step> steps;
  palpate_loop_report report{};
};

TEST_F(PalpateLoop, GivesEveryRecordedStep) {
  const RecordedLoop loop(state_, 1000);
  ASSERT_EQ(loop.steps.size(), 151U);
  EXPECT_EQ(loop.report.unrecorded, 0U);
  // The same motion by palpate_step: the same forces and energies, to the bit.
  palpate_state_reset(state_);
  double largest = 0;
  for (std::size_t i = 0; i + 1 < loop.steps.size(); ++i) {
    const palpate_loop_step& recorded = loop.steps[i];
    EXPECT_EQ(recorded.position[2], 0.0005 - 2e-5 * static_cast<double>(i));
    EXPECT_EQ(recorded.velocity[2], -0.02);
    const std::uint32_t status =
        step({recorded.position[0], recorded.position[1], recorded.position[2]});
    const palpate_observation seen = observe();
    EXPECT_EQ(recorded.status, status);
    EXPECT_EQ(recorded.element, seen.element);
    EXPECT_EQ(recorded.depth, seen.depth);
    EXPECT_EQ(recorded.energy, seen.energy);
    EXPECT_EQ(recorded.absorbed, seen.absorbed);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(recorded.force[k], force_[k]);
      EXPECT_EQ(recorded.contact_point[k], seen.contact_point[k]);
    }
    if (i > 0) {
      EXPECT_GT(recorded.time_ns, loop.steps[i - 1].time_ns);
    }
    largest = std::max(largest, recorded.force[2]);
  }
  EXPECT_GT(largest, 0.1);
  const palpate_loop_step& last = loop.steps.back();
  EXPECT_NE(last.status & PALPATE_LOOP_DEVICE_LOST, 0U);
  EXPECT_EQ(last.force[2], 0);
}

TEST_F(PalpateLoop, CountsTheStepsForWhichTheRecordHasNoRoom) {
  const RecordedLoop full(state_, 100);
  ASSERT_EQ(full.steps.size(), 100U);
  EXPECT_EQ(full.report.unrecorded, 51U);
  EXPECT_EQ(full.steps.back().position[2], 0.0005 - 2e-5 * 99);
  const RecordedLoop none(state_, 0);
  EXPECT_TRUE(none.steps.empty());
  EXPECT_EQ(none.report.unrecorded, 0U);
  EXPECT_EQ(palpate_loop_take(nullptr, nullptr), 0);
  palpate_loop_end(nullptr);
}

/// Presses into the body, and then has no new sample for ever.
struct SilentDevice : OwnDevice {
  static int read_or_not(void* self, double position[3], double velocity[3]) {
    auto& d = *static_cast<SilentDevice*>(self);
    if (d.reads < 120) return read(self, position, velocity);
    position[0] = 0.03, position[1] = 0.033, position[2] = 0.0005 - 2e-5 * d.reads;
    velocity[0] = velocity[1] = velocity[2] = 0;
    return 1;
  }
  palpate_device functions() {
    return {sizeof(palpate_device), this, read_or_not, command, nullptr, 0};
  }
};

TEST_F(PalpateLoop, ADeviceWithoutNewSamplesLosesItsForceAndTheLoopEnds) {
  SilentDevice own;
  const palpate_device device = own.functions();
  palpate_loop_settings settings;
  palpate_loop_settings_default(&settings);
  settings.priority = 0;
  settings.ramp = 0;
  settings.rate = 100;  // 20 periods are long enough for a busy machine
  settings.watchdog = 0.05;
  settings.record = 10000;
  palpate_loop* loop = nullptr;
  ASSERT_EQ(palpate_loop_start(state_, &device, &settings, &loop), PALPATE_OK);
  palpate_loop* second = nullptr;
  EXPECT_EQ(palpate_loop_start(state_, &device, &settings, &second), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(second, nullptr);
  EXPECT_NE(std::string(palpate_last_error()).find("belongs to a loop"), std::string::npos);
  for (int i = 0; i < 60000 && palpate_loop_running(loop); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(palpate_loop_running(loop), 0);
  palpate_loop_end(loop);
  palpate_loop_step step{};
  step.size = sizeof step;
  double last = 1;
  while (palpate_loop_take(loop, &step) == 1) last = std::abs(step.force[2]);
  EXPECT_TRUE(step.status & PALPATE_LOOP_DEVICE_LOST);
  EXPECT_TRUE(step.status & PALPATE_LOOP_OUTDATED);
  EXPECT_EQ(last, 0);
  EXPECT_EQ(own.last, 0);
  EXPECT_GT(own.largest, 0.01);
  palpate_loop_report report{};
  report.size = sizeof report;
  EXPECT_EQ(palpate_loop_stop(loop, &report), PALPATE_OK);
  EXPECT_EQ(report.lost, 1U);
  EXPECT_EQ(report.silent, 1U);
  EXPECT_GT(report.outdated, 100U);
}

/// Largest force of a loop over the device of these settings and this continuous force.
double largest_force(palpate_state* state, double max_force, double continuous,
                     std::uint32_t device_size = sizeof(palpate_device)) {
  palpate_state_reset(state);
  OwnDevice own;
  palpate_device device = own.functions();
  device.continuous_force = continuous;
  device.size = device_size;
  palpate_loop_settings settings = patient_settings();
  settings.max_force = max_force;
  palpate_loop* loop = nullptr;
  EXPECT_EQ(palpate_loop_start(state, &device, &settings, &loop), PALPATE_OK);
  wait_for_end(loop);
  EXPECT_EQ(palpate_loop_stop(loop, nullptr), PALPATE_OK);
  return own.largest;
}

TEST_F(PalpateLoop, TheClampIsByDefaultTheContinuousForceOfTheDevice) {
  constexpr double kNoClamp = std::numeric_limits<double>::infinity();
  ASSERT_GT(largest_force(state_, kNoClamp, 0), 0.09);
  EXPECT_NEAR(largest_force(state_, kNoClamp, 0.05), 0.05, 1e-12);
  EXPECT_NEAR(largest_force(state_, 0.08, 0.05), 0.08, 1e-12);
  // A program of an older header states none, whatever lies behind its struct.
  EXPECT_GT(largest_force(state_, kNoClamp, 0.05, offsetof(palpate_device, continuous_force)),
            0.09);
}

/// Starts a loop on plate_of_200() and ends it. @return result of the start; `report`: of the loop.
int start_loop_at(double rate, const palpate_device_constants* constants, std::uint32_t uncertified,
                  palpate_loop_report& report) {
  const palpate_library body(plate_of_200());
  palpate_state state(body, {.friction = 0.3, .lipschitz_bound = 200});
  OwnDevice own;
  const palpate_device device = own.functions();
  palpate_loop_settings settings = settings_at(rate);
  settings.constants = constants;
  settings.uncertified = uncertified;
  palpate_loop* loop = nullptr;
  const int started = palpate_loop_start(&state, &device, &settings, &loop);
  report = {};
  report.size = sizeof report;
  EXPECT_EQ(loop != nullptr, started == PALPATE_OK);
  if (loop == nullptr) return started;
  const int certified = palpate_loop_certified(loop);
  EXPECT_EQ(palpate_loop_stop(loop, &report), PALPATE_OK);
  EXPECT_EQ(report.certified, static_cast<std::uint32_t>(certified));
  return started;
}

TEST_F(PalpateLoop, ComparesItsRateWithTheCertificate) {
  // (C7) without delay: 1.5 L/b = 300 Hz at 1 N s/m.
  const palpate_device_constants constants{
      sizeof(palpate_device_constants), 1, 0.1, 0, 10e-6, 1e-3};
  palpate_loop_report report;
  EXPECT_EQ(start_loop_at(301, &constants, 0, report), PALPATE_OK);
  EXPECT_EQ(report.certified, 1U);
  EXPECT_EQ(start_loop_at(299, &constants, 0, report), PALPATE_ERROR_UNCERTIFIED);
  EXPECT_NE(std::strstr(palpate_last_error(), "damping"), nullptr) << palpate_last_error();
  EXPECT_EQ(start_loop_at(299, &constants, 1, report), PALPATE_OK);
  EXPECT_EQ(report.certified, 0U);
  EXPECT_EQ(start_loop_at(301, nullptr, 0, report), PALPATE_OK);
  EXPECT_EQ(report.certified, 0U);
  EXPECT_NE(std::strstr(palpate_last_error(), "unknown of the device"), nullptr);
  EXPECT_EQ(palpate_loop_certified(nullptr), PALPATE_ERROR_ARGUMENT);
}

TEST_F(PalpateLoop, TheWatchdogIsTwentyPeriodsByDefault) {
  // At 10 Hz two seconds: twenty milliseconds would halt the device between two steps.
  OwnDevice own;
  const palpate_device device = own.functions();
  palpate_loop_settings settings = settings_at(10);
  EXPECT_EQ(settings.watchdog, 0);
  palpate_loop* loop = nullptr;
  ASSERT_EQ(palpate_loop_start(state_, &device, &settings, &loop), PALPATE_OK);
  std::this_thread::sleep_for(std::chrono::milliseconds(450));
  palpate_loop_report report{};
  report.size = sizeof report;
  EXPECT_EQ(palpate_loop_stop(loop, &report), PALPATE_OK);
  EXPECT_EQ(report.halted, 0U);
  EXPECT_EQ(report.lost, 0U);
  EXPECT_EQ(report.late, 0U);
}

TEST_F(PalpateLoop, RefusesSettingsOutOfRange) {
  OwnDevice own;
  palpate_device device = own.functions();
  palpate_loop* loop = nullptr;
  palpate_loop_settings settings;
  palpate_loop_settings_default(&settings);
  settings.rate = 0;
  EXPECT_EQ(palpate_loop_start(state_, &device, &settings, &loop), PALPATE_ERROR_ARGUMENT);
  EXPECT_NE(std::strstr(palpate_last_error(), "rate"), nullptr);
  palpate_loop_settings_default(&settings);
  settings.wake_early = 0.9 / settings.rate;
  EXPECT_EQ(palpate_loop_start(state_, &device, &settings, &loop), PALPATE_ERROR_ARGUMENT);
  EXPECT_NE(std::strstr(palpate_last_error(), "wake_early"), nullptr);
  settings.size = 3;
  EXPECT_EQ(palpate_loop_start(state_, &device, &settings, &loop), PALPATE_ERROR_ARGUMENT);
  device.read = nullptr;
  EXPECT_EQ(palpate_loop_start(state_, &device, nullptr, &loop), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(palpate_loop_start(nullptr, &device, nullptr, &loop), PALPATE_ERROR_ARGUMENT);
  EXPECT_EQ(loop, nullptr);
  EXPECT_EQ(palpate_loop_running(nullptr), 0);
  EXPECT_EQ(palpate_loop_stop(nullptr, nullptr), PALPATE_ERROR_ARGUMENT);
}

}  // namespace
}  // namespace palpate::test
