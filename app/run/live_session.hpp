// SPDX-License-Identifier: AGPL-3.0-or-later
// A session in real time: device, force loop, recording.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "format/recording.hpp"
#include "runtime/device.hpp"
#include "runtime/force_loop.hpp"
#include "runtime/handles.hpp"
#include "runtime/loop_thread.hpp"

namespace palpate::app {

struct LiveSettings {
  runtime::ContactSettings contact;
  runtime::SafetySettings safety;
  runtime::LoopThreadSettings loop;
  runtime::Pose pose;        ///< of the body in the frame of the device
  double search_rate = 100;  ///< Hz
  double duration = 0;       ///< s; 0 = until stopped
};

/// As they are recorded.
SessionSettings session_settings(const LiveSettings& live);

struct LiveOutcome {
  std::vector<RecordedStep> steps;
  runtime::LoopCounts counts;
  std::string missing_rights;  ///< one line, empty when all was granted
  bool halted = false;         ///< by the watchdog
};

/// Opens the device, runs the loop until the time is over, `stop` is set, or the device is lost,
/// and closes it. What was recorded until then is kept in any case. @throws Error from opening.
LiveOutcome run_live(runtime::Device& device, const palpate_library& body,
                     const LiveSettings& settings, const std::atomic<bool>& stop);

}  // namespace palpate::app
