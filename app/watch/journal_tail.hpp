// SPDX-License-Identifier: AGPL-3.0-or-later
// The steps of sessions while they are being recorded, by another process.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>

#include "app/watch/session_news.hpp"
#include "format/session_journal.hpp"

namespace palpate::app {

/// Follows the journal of a recording: it reads what is in the file and takes no lock, so that a
/// session is never aware of it. A session that follows in the same journal is followed too. Not
/// thread-safe.
class JournalTail {
 public:
  explicit JournalTail(std::filesystem::path journal) : path_(std::move(journal)) {}

  /// What has come since the last call; `ended`: the journal is gone. @throws Error when the disk
  /// refuses.
  SessionNews poll();

 private:
  bool open();
  bool is_gone() const;

  std::filesystem::path path_;
  std::optional<SessionJournalReader> reader_;
  ino_t file_ = 0;
};

}  // namespace palpate::app
