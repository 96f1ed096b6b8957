// SPDX-License-Identifier: Apache-2.0
// The journal of a session in progress. Normative page:
// format/schema/session.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
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

/// Damaged bytes of a journal, between whole records or behind the last.
struct JournalGap {
  std::uint64_t offset = 0, bytes = 0;   ///< in the file
  std::optional<std::uint64_t> steps;    ///< lost; none where the bytes are not whole records
  std::optional<std::int64_t> since_ns;  ///< time of the last step in front of it
  std::optional<std::int64_t> until_ns;  ///< time of the first step behind it
};

/// "12 steps (2084 bytes at byte 9123) after 1.500 s before 1.513 s"
std::string gap_text(const JournalGap& gap);

/// Reads a journal record by record. A record whose digest is not that of its bytes is passed over
/// to the next whole one, wherever that begins. Not thread-safe.
class SessionJournalReader {
 public:
  /// @throws Error(Configuration) when the file is no journal of a session or has no whole heading.
  explicit SessionJournalReader(const std::filesystem::path& path);

  const RecordingHeading& heading() const { return heading_; }
  /// The steps of the next whole record; false behind the last.
  bool next(std::vector<RecordedStep>& steps);
  /// The steps of the next whole record of a file that another process writes, as it is now; false
  /// where there is none yet. Damage ends it: it is never passed. Instead of next().
  bool follow(std::vector<RecordedStep>& steps);
  /// Behind the last whole record: the front of one that the end of the session cut short. After
  /// next() was false.
  std::uint64_t incomplete_bytes() const { return incomplete_; }
  /// The damage that was passed so far.
  const std::vector<JournalGap>& gaps() const { return gaps_; }

 private:
  bool pass_damage();
  bool take_next(std::vector<RecordedStep>& steps);
  void close_gap(const std::vector<RecordedStep>& steps);

  std::string where_;
  std::ifstream file_;
  std::uint64_t size_ = 0, good_ = 0, incomplete_ = 0;
  bool at_end_ = false;
  std::optional<std::int64_t> last_time_ns_;
  std::vector<JournalGap> gaps_;
  RecordingHeading heading_;
};

/// Is this the journal of a session (by its first bytes)?
bool is_session_journal(const std::filesystem::path& path);

/// Is this such a journal with more in it than the front of a heading?
bool holds_session(const std::filesystem::path& path);

struct SessionSummary {
  RecordingHeading heading;
  std::uint64_t steps = 0;
  std::int64_t last_time_ns = 0;
  std::uint64_t incomplete_bytes = 0;  ///< of a record that was being written
  std::vector<JournalGap> gaps;        ///< damage
};
SessionSummary summarize_session(const std::filesystem::path& journal);

/// The whole steps of the journal as a recording, with this provenance; in the memory of a few
/// thousand steps. The journal stays. @return how many.
std::uint64_t write_recording_of(const std::filesystem::path& journal,
                                 const std::filesystem::path& recording,
                                 const Provenance& provenance);

}  // namespace palpate
