// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <atomic>

#include "app/run/live_session.hpp"
#include "format/recording.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {

/// A live session and what came back from the disk.
struct Played {
  LiveOutcome outcome;
  Recording recording;
};

inline Played play_live(runtime::Device& device, const palpate_library& body,
                        const LiveSettings& settings, const std::atomic<bool>& stop) {
  const samples::TemporaryFolder folder;
  RecordingHeading heading;
  heading.device = device.name();
  heading.rate = settings.loop.rate;
  heading.friction = settings.contact.friction;
  heading.settings = session_settings(settings);
  device.open();
  SessionRecorder recorder(folder / "recording.h5", heading);
  Played played;
  played.outcome = run_live(device, body, settings, recorder, stop);
  recorder.finish();
  played.recording = read_recording(folder / "recording.h5");
  return played;
}

}  // namespace palpate::app
