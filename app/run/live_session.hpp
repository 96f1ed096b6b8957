// SPDX-License-Identifier: AGPL-3.0-or-later
// A session in real time: device, force loop, recording.
#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "app/record/session_recorder.hpp"
#include "format/error.hpp"
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
  double duration = 0;       ///< s from the first step; 0 = until stopped
};

/// Sets the watchdog of the loop and of its safety functions (s; none: that of the rate), and their
/// period. After the rate.
void set_watchdog(LiveSettings& live, std::optional<double> watchdog);

/// The settings in the form of a recording.
SessionSettings session_settings(const LiveSettings& live);

struct LiveOutcome {
  runtime::LoopCounts counts;
  std::string missing_rights;         ///< one line; empty: none
  bool halted = false;                ///< by the watchdog
  std::optional<Error> not_recorded;  ///< failure of the disk that ended the session
};

/// Runs the loop on an open device until the time is over, `stop` is set, the device is lost, or
/// the disk is full, and closes the device. The recorded steps are in the recorder or its journal.
LiveOutcome run_live(runtime::Device& device, const palpate_library& body,
                     const LiveSettings& settings, SessionRecorder& recorder,
                     const std::atomic<bool>& stop);

}  // namespace palpate::app
