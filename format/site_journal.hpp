// SPDX-License-Identifier: Apache-2.0
// The journal of the finished sites of a campaign in progress. Normative page:
// format/schema/journal.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "format/curves.hpp"
#include "format/record_file.hpp"

namespace palpate {

/// Identity of a campaign: campaigns with the same key and count compute the same.
struct JournalHeading {
  std::string key;                 ///< 64 hexadecimal digits
  std::int64_t planned_sites = 0;  ///< of the campaign

  bool operator==(const JournalHeading&) const = default;
};

struct JournalContents {
  JournalHeading heading;
  std::vector<SiteCurves> sites;   ///< in the order in which they finished
  std::uint64_t good_bytes = 0;    ///< up to the end of the last whole record
  std::uint64_t broken_bytes = 0;  ///< after it: a record cut short by a crash, or damage
};

/// @throws Error(Configuration) when the file is no journal.
JournalContents read_site_journal(const std::filesystem::path& path);

/// Keeps each finished site on the disk. A site is there wholly or not at all: each record carries
/// its SHA-256, and what follows the last whole record is dropped when the journal is opened again.
/// Held by one process at a time. Not thread-safe.
class SiteJournal {
 public:
  /// Continue the journal at `path`, or begin it. One of another campaign is moved aside to
  /// `<path>.old` (replacing an older one). @throws Error when the disk refuses, or Configuration
  /// when another process holds it.
  SiteJournal(const std::filesystem::path& path, const JournalHeading& heading);

  const std::vector<SiteCurves>& found() const { return found_; }  ///< sites of an earlier run
  std::uint64_t dropped_bytes() const { return dropped_bytes_; }
  bool moved_aside() const { return moved_aside_; }

  /// On the disk when it returns. When the disk refuses, the journal is as it was before.
  void append(const SiteCurves& site);

  /// The campaign is complete and its curves are written: the journal has done its work.
  void remove();

 private:
  void continue_or_begin(const JournalHeading& heading);
  void move_aside();
  void begin(const JournalHeading& heading);

  RecordFile file_;
  std::vector<SiteCurves> found_;
  std::uint64_t dropped_bytes_ = 0;
  bool moved_aside_ = false;
};

}  // namespace palpate
