// SPDX-License-Identifier: AGPL-3.0-or-later
// A force loop on a plate, with a device that does what a test tells it.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/force_loop.hpp"
#include "runtime/handles.hpp"
#include "tests/support/bodies.hpp"
#include "tests/unit/runtime/scripted_device.hpp"

namespace palpate::test {

inline const runtime::SafetySettings kPatient{0, 1000, 1000, 1e6};  // no ramp, no cut-off

inline const palpate_library& plate_body() {
  static const palpate_library body(
      plate(8, 0.08, [](const Vec3&) { return wall_response(170, 120); }));
  return body;
}

/// Presses 20 um a step from 0.5 mm above.
inline runtime::DeviceReading pressing(int step) {
  return {{0.04, 0.04, 5e-4 - 2e-5 * step}, {0, 0, -0.02}, 0};
}

inline std::vector<RecordedStep> drain(runtime::StepQueue& queue) {
  std::vector<RecordedStep> steps;
  RecordedStep step;
  while (queue.try_dequeue(step)) steps.push_back(step);
  return steps;
}

/// A force loop over a scripted device on a plate.
struct LoopRig {
  explicit LoopRig(const runtime::SafetySettings& safety = kPatient, std::size_t room = 4096)
      : state(plate_body(), {0.3, 5e-3}), queue(room), loop(device, state, safety, &queue) {
    device.place = pressing;
  }
  /// A step `dt` (s) after the last, by a clock of the test.
  bool step(double dt) {
    now += std::llround(1e9 * dt);
    return loop.tick(now, now);
  }
  ScriptedDevice device;
  palpate_state state;
  runtime::StepQueue queue;
  runtime::ForceLoop loop;
  std::int64_t now = 1;  ///< ns
};

}  // namespace palpate::test
