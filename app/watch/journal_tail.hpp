// SPDX-License-Identifier: AGPL-3.0-or-later
// The steps of sessions while they are being recorded, by another process.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "format/recording.hpp"
#include "format/session_journal.hpp"

namespace palpate::app {

/// Follows the journal of a recording: it reads what is in the file and takes no lock, so that a
/// session is never aware of it. A session that follows in the same journal is followed too. Not
/// thread-safe.
class JournalTail {
 public:
  explicit JournalTail(std::filesystem::path journal) : path_(std::move(journal)) {}

  struct News {
    std::optional<RecordingHeading> begun;  ///< a session began
    std::vector<RecordedStep> steps;        ///< of it, since the last call
    bool ended = false;                     ///< its journal is gone
  };
  /// What has come since the last call, in parts where that is much. @throws Error when the disk
  /// refuses.
  News poll();

 private:
  bool open();
  bool is_gone() const;

  std::filesystem::path path_;
  std::optional<SessionJournalReader> reader_;
  ino_t file_ = 0;
};

}  // namespace palpate::app
