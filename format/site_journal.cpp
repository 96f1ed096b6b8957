// SPDX-License-Identifier: Apache-2.0
#include "format/site_journal.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include "format/disk_error.hpp"
#include "format/error.hpp"
#include "format/regular_file.hpp"
#include "format/site_record.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kJournalFirstLine = "palpate.journal 4\n";

RecordFile open_journal(const fs::path& path) {
  return {path, "another palpate is at this campaign",
          "wait until it ends, or name another folder with --out"};
}

std::string heading_text(const JournalHeading& heading) {
  return std::string(kJournalFirstLine) + heading.key + "\n" +
         std::to_string(heading.planned_sites) + "\n";
}

std::string_view take_line(std::string_view& bytes) {
  const auto end = bytes.find('\n');
  const std::string_view line = bytes.substr(0, end);
  bytes = end == std::string_view::npos ? std::string_view{} : bytes.substr(end + 1);
  return line;
}

std::string bytes_of(const fs::path& path) {
  require_regular_file(path, "name the journal of a campaign");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw_disk_error(path, "cannot be read", errno);
  return {std::istreambuf_iterator<char>(file), {}};
}

JournalHeading take_heading(std::string_view& bytes, const fs::path& path) {
  const auto fail = [&] {
    throw Error(ErrorKind::Configuration, path.string(), "is no journal of a campaign",
                "remove it, or name a journal of this version of palpate");
  };
  if (!bytes.starts_with(kJournalFirstLine)) fail();
  bytes.remove_prefix(kJournalFirstLine.size());
  JournalHeading heading;
  heading.key = take_line(bytes);
  const std::string_view count = take_line(bytes);
  const auto parsed =
      std::from_chars(count.data(), count.data() + count.size(), heading.planned_sites);
  if (heading.key.size() != kDigestDigits || parsed.ec != std::errc() || heading.planned_sites < 0)
    fail();
  return heading;
}

/// A crash right after the file was made leaves less than a heading.
bool is_cut_heading(std::string_view bytes) {
  return kJournalFirstLine.starts_with(bytes.substr(0, kJournalFirstLine.size())) &&
         std::count(bytes.begin(), bytes.end(), '\n') < 3;
}

}  // namespace

JournalContents read_site_journal(const fs::path& path) {
  const std::string bytes = bytes_of(path);
  std::string_view rest = bytes;
  JournalContents contents;
  contents.heading = take_heading(rest, path);
  std::string_view payload;
  while (take_record(rest, payload))
    contents.sites.push_back(site_from_bytes(payload, path.string()));
  contents.good_bytes = bytes.size() - rest.size();
  contents.broken_bytes = rest.size();
  return contents;
}

SiteJournal::SiteJournal(const fs::path& path, const JournalHeading& heading)
    : file_(open_journal(path)) {
  continue_or_begin(heading);
}

void SiteJournal::continue_or_begin(const JournalHeading& heading) {
  if (is_cut_heading(bytes_of(file_.path()))) return begin(heading);
  JournalContents before = read_site_journal(file_.path());
  if (before.heading != heading) {
    move_aside();
    return begin(heading);
  }
  found_ = std::move(before.sites);
  dropped_bytes_ = before.broken_bytes;
  file_.cut(before.good_bytes);
}

void SiteJournal::move_aside() {
  const fs::path path = file_.path();
  const fs::path old = path.string() + ".old";
  if (::rename(path.c_str(), old.c_str()) != 0)
    throw_disk_error(path, "cannot be moved aside", errno);
  file_ = open_journal(path);
  moved_aside_ = true;
}

void SiteJournal::begin(const JournalHeading& heading) {
  file_.cut(0);
  file_.append_durably(heading_text(heading));
  if (const int problem = sync_folder_of(file_.path()); problem != 0)
    throw_disk_error(file_.path(), "is made, but its folder cannot be put on the disk", problem);
}

void SiteJournal::append(const SiteCurves& site) {
  file_.append_durably(record_of(site_bytes(site)));
}

void SiteJournal::remove() {
  file_.remove();
}

}  // namespace palpate
