// SPDX-License-Identifier: Apache-2.0
// The journal of a session in progress. Normative page:
// format/schema/session.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "format/record_file.hpp"
#include "format/recording.hpp"

namespace palpate {

/// The recorded steps survive a crash, in whole records, each with its SHA-256. One process at a
/// time has the journal open. Not thread-safe.
class SessionJournal {
 public:
  /// Begins the journal of a session; nothing but a heading cut short may be there. @throws Error
  /// when the disk refuses, or Configuration when another process holds it or another session is in
  /// it.
  SessionJournal(const std::filesystem::path& path, const RecordingHeading& heading);

  /// The steps are with the system: a crash of the process does not lose them. When the disk
  /// refuses, the journal is as it was before.
  void append(const std::vector<RecordedStep>& steps);
  /// Nor does a crash of the machine, for what was appended until now.
  void synchronize() { file_.synchronize(); }
  /// Its recording is written: the journal has done its work.
  void remove() { file_.remove(); }

  const std::filesystem::path& path() const { return file_.path(); }
  std::uint64_t steps() const { return steps_; }

 private:
  RecordFile file_;
  std::uint64_t steps_ = 0;
};

/// Reads a journal from the front, record by record, up to the first that is not whole.
class SessionJournalReader {
 public:
  /// @throws Error(Configuration) when the file is no journal of a session.
  explicit SessionJournalReader(const std::filesystem::path& path);

  const RecordingHeading& heading() const { return heading_; }
  /// The steps of the next record; false behind the last whole one.
  bool next(std::vector<RecordedStep>& steps);
  /// Behind the last whole record: one that a crash cut short, or damage. After next() was false.
  std::uint64_t broken_bytes() const { return size_ - good_; }

 private:
  std::string where_;
  std::ifstream file_;
  std::uint64_t size_ = 0, good_ = 0;
  RecordingHeading heading_;
};

/// Is this the journal of a session (by its first bytes)?
bool is_session_journal(const std::filesystem::path& path);

struct SessionSummary {
  RecordingHeading heading;
  std::uint64_t steps = 0;
  std::int64_t last_time_ns = 0;
  std::uint64_t broken_bytes = 0;
};
SessionSummary summarize_session(const std::filesystem::path& journal);

/// The whole steps of the journal as a recording, with this provenance; in the memory of a few
/// thousand steps. The journal stays. @return how many.
std::uint64_t write_recording_of(const std::filesystem::path& journal,
                                 const std::filesystem::path& recording,
                                 const Provenance& provenance);

}  // namespace palpate
