// SPDX-License-Identifier: Apache-2.0
#include "format/site_journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include "format/disk_error.hpp"
#include "format/error.hpp"
#include "format/sha256.hpp"
#include "format/site_record.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFirstLine = "palpate.journal 2\n";
constexpr std::size_t kDigest = 64;

std::string heading_text(const JournalHeading& heading) {
  return std::string(kFirstLine) + heading.key + "\n" + std::to_string(heading.planned_sites) +
         "\n";
}

/// Length, bytes of the site, SHA-256 of these bytes.
std::string record_of(const SiteCurves& site) {
  const std::string payload = site_bytes(site);
  const auto length = static_cast<std::uint32_t>(payload.size());
  std::string record(sizeof length, '\0');
  std::memcpy(record.data(), &length, sizeof length);
  return record + payload + sha256(payload);
}

/// Takes a whole record off the front of `bytes`; false when there is none.
bool take_record(std::string_view& bytes, std::string_view& payload) {
  std::uint32_t length = 0;
  if (bytes.size() < sizeof length) return false;
  std::memcpy(&length, bytes.data(), sizeof length);
  const std::string_view rest = bytes.substr(sizeof length);
  if (rest.size() < length + kDigest) return false;
  if (sha256(rest.substr(0, length)) != rest.substr(length, kDigest)) return false;
  payload = rest.substr(0, length);
  bytes = rest.substr(length + kDigest);
  return true;
}

std::string_view take_line(std::string_view& bytes) {
  const auto end = bytes.find('\n');
  const std::string_view line = bytes.substr(0, end);
  bytes = end == std::string_view::npos ? std::string_view{} : bytes.substr(end + 1);
  return line;
}

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw_disk_error(path, "cannot be read", errno);
  return {std::istreambuf_iterator<char>(file), {}};
}

JournalHeading take_heading(std::string_view& bytes, const fs::path& path) {
  const auto fail = [&] {
    throw Error(ErrorKind::Configuration, path.string(), "is no journal of a campaign",
                "remove it, or name a journal of this version of palpate");
  };
  if (!bytes.starts_with(kFirstLine)) fail();
  bytes.remove_prefix(kFirstLine.size());
  JournalHeading heading;
  heading.key = take_line(bytes);
  const std::string_view count = take_line(bytes);
  const auto parsed =
      std::from_chars(count.data(), count.data() + count.size(), heading.planned_sites);
  if (heading.key.size() != kDigest || parsed.ec != std::errc() || heading.planned_sites < 0)
    fail();
  return heading;
}

/// A crash right after the file was made leaves less than a heading.
bool is_cut_heading(std::string_view bytes) {
  return kFirstLine.starts_with(bytes.substr(0, kFirstLine.size())) &&
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

SiteJournal::SiteJournal(const fs::path& path, const JournalHeading& heading) : path_(path) {
  open_and_lock();
  try {
    continue_or_begin(heading);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

SiteJournal::~SiteJournal() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void SiteJournal::open_and_lock() {
  descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw_disk_error(path_, "cannot be opened", errno);
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  const int problem = errno;
  ::close(std::exchange(descriptor_, -1));
  if (problem != EWOULDBLOCK) throw_disk_error(path_, "cannot be locked", problem);
  throw Error(ErrorKind::Configuration, path_.string(), "another palpate is at this campaign",
              "wait until it ends, or name another folder with --out");
}

void SiteJournal::continue_or_begin(const JournalHeading& heading) {
  if (is_cut_heading(bytes_of(path_))) return begin(heading);
  JournalContents before = read_site_journal(path_);
  if (before.heading != heading) {
    move_aside();
    return begin(heading);
  }
  found_ = std::move(before.sites);
  end_ = before.good_bytes;
  dropped_bytes_ = before.broken_bytes;
  if (dropped_bytes_ > 0 && ::ftruncate(descriptor_, static_cast<off_t>(end_)) != 0)
    throw_disk_error(path_, "cannot be shortened", errno);
}

void SiteJournal::move_aside() {
  const fs::path old = path_.string() + ".old";
  if (::rename(path_.c_str(), old.c_str()) != 0)
    throw_disk_error(path_, "cannot be moved aside", errno);
  ::close(std::exchange(descriptor_, -1));
  open_and_lock();
  moved_aside_ = true;
}

void SiteJournal::begin(const JournalHeading& heading) {
  if (::ftruncate(descriptor_, 0) != 0) throw_disk_error(path_, "cannot be emptied", errno);
  end_ = 0;
  write_at_end(heading_text(heading));
  if (const int problem = sync_folder_of(path_); problem != 0)
    throw_disk_error(path_, "is made, but its folder cannot be put on the disk", problem);
}

void SiteJournal::append(const SiteCurves& site) {
  write_at_end(record_of(site));
}

void SiteJournal::write_at_end(const std::string& bytes) {
  const auto refuse = [&](const char* action) {
    const int problem = errno;
    // If even this fails, the next opening drops the broken record.
    [[maybe_unused]] const int ignored = ::ftruncate(descriptor_, static_cast<off_t>(end_));
    throw_disk_error(path_, action, problem);
  };
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data() + done, bytes.size() - done,
                                     static_cast<off_t>(end_ + done));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) refuse("cannot be written");
    done += static_cast<std::size_t>(written);
  }
  if (::fdatasync(descriptor_) != 0) refuse("cannot be put on the disk");
  end_ += bytes.size();
}

void SiteJournal::remove() {
  if (::unlink(path_.c_str()) != 0) throw_disk_error(path_, "cannot be removed", errno);
}

}  // namespace palpate
