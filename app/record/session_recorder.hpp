// SPDX-License-Identifier: AGPL-3.0-or-later
// Writes a session to a journal while it runs and to recording.h5 when it ends.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/record/depth_watch.hpp"
#include "format/error.hpp"
#include "format/recording.hpp"
#include "format/session_journal.hpp"

namespace palpate::app {

/// The journal of a recording: recording.h5 -> recording.journal.
std::filesystem::path journal_of(const std::filesystem::path& recording);

struct Recovered {
  std::filesystem::path recording;
  std::uint64_t steps = 0;
  std::uint64_t dropped_bytes = 0;     ///< of a record that was being written
  std::vector<JournalGap> gaps;        ///< damage
  std::filesystem::path kept_journal;  ///< recording.journal.damaged, where there are gaps
};

/// Makes the recording of an interrupted session and removes its journal; a damaged journal is
/// renamed instead, so that nothing is lost that palpate cannot read. The provenance of the
/// recording has a stage `recover` that states the gaps. @throws Error when the disk refuses (the
/// journal stays), or Configuration when the file is not a journal or its session is still running.
Recovered recover(const std::filesystem::path& journal, const std::filesystem::path& recording);

/// The same for the journal that an earlier session left beside `recording`, under a free name:
/// recording.recovered-1.h5. Nothing when there is none.
std::optional<Recovered> recover_interrupted(const std::filesystem::path& recording);

/// The same error, its remedy extended by `palpate recover`.
[[noreturn]] void throw_with_journal(const Error& error, const std::filesystem::path& journal);

/// Writes steps to the journal some thirty times a second and synchronizes it every second, which
/// bounds what a crash can lose. Memory does not grow with the session. One thread at a time.
class SessionRecorder {
 public:
  /// Begins the journal; that of an earlier session must be recovered first (recover_interrupted).
  SessionRecorder(std::filesystem::path recording, const RecordingHeading& heading);

  /// @throws Error when the disk refuses; what is in the journal stays there.
  void add(const RecordedStep& step);
  /// Call it regularly where steps come in real time: writes steps that have waited long enough.
  void breathe();
  /// Writes recording.h5, its last stage of provenance ending now, and removes the journal. @throws
  /// Error when the disk refuses; the journal stays, and the remedy names it.
  void finish();

  std::uint64_t steps() const { return journal_.steps() + waiting_.size(); }
  const DepthWatch& depths() const { return depths_; }  ///< of all steps
  const std::filesystem::path& journal() const { return journal_.path(); }

 private:
  using Clock = std::chrono::steady_clock;
  void write_waiting();

  std::filesystem::path recording_;
  Provenance provenance_;
  SessionJournal journal_;
  std::vector<RecordedStep> waiting_;
  DepthWatch depths_;
  Clock::time_point written_ = Clock::now(), synchronized_ = written_;
};

}  // namespace palpate::app
