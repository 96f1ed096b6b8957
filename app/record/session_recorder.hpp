// SPDX-License-Identifier: AGPL-3.0-or-later
// A session on its way to recording.h5: in a journal while it runs, a recording when it ends.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "format/error.hpp"
#include "format/recording.hpp"
#include "format/session_journal.hpp"

namespace palpate::app {

/// Where the steps are kept until the recording is written: recording.h5 -> recording.journal.
std::filesystem::path journal_of(const std::filesystem::path& recording);

struct Recovered {
  std::filesystem::path recording;
  std::uint64_t steps = 0;
  std::uint64_t dropped_bytes = 0;  ///< of a record that was being written
};

/// Makes the recording of a session that was cut off, and removes its journal. Its provenance says
/// so. @throws Error when the disk refuses (the journal stays), or Configuration when the journal
/// is none or its session is still running.
Recovered recover(const std::filesystem::path& journal, const std::filesystem::path& recording);

/// The same for what an earlier session left where `recording` will be written, under a free name
/// beside it: recording.recovered-1.h5. None when nothing was left.
std::optional<Recovered> recover_what_was_left(const std::filesystem::path& recording);

/// The same error with the remedy that the journal is.
[[noreturn]] void throw_keeping_journal(const Error& error, const std::filesystem::path& journal);

/// Steps go to the journal several times a second, and to the disk every second, so that a crash of
/// the process or of the machine loses no more. Memory does not grow with the session. One thread
/// at a time.
class SessionRecorder {
 public:
  /// Begins the journal; nothing of an earlier session may be there (recover_what_was_left).
  SessionRecorder(std::filesystem::path recording, const RecordingHeading& heading);

  /// @throws Error when the disk refuses; what is in the journal stays there.
  void add(const RecordedStep& step);
  /// To be called now and then where steps come in real time: writes what waits long enough.
  void breathe();
  /// Writes recording.h5, its last stage of provenance ending now, and removes the journal. @throws
  /// Error when the disk refuses; the journal stays, and the remedy names it.
  void finish();

  std::uint64_t steps() const { return journal_.steps() + waiting_.size(); }
  const std::filesystem::path& journal() const { return journal_.path(); }

 private:
  using Clock = std::chrono::steady_clock;
  void write_waiting();

  std::filesystem::path recording_;
  Provenance provenance_;
  SessionJournal journal_;
  std::vector<RecordedStep> waiting_;
  Clock::time_point written_ = Clock::now(), synchronized_ = written_;
};

}  // namespace palpate::app
