// SPDX-License-Identifier: Apache-2.0
#include "format/crash_safe_file.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include "format/disk_error.hpp"
#include "format/error.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

/// The file a symbolic link leads to: renaming over the link itself would cut it off.
fs::path without_links(const fs::path& target) {
  std::error_code ignored;
  if (!fs::is_symlink(target, ignored)) return target;
  const fs::path followed = fs::weakly_canonical(target, ignored);
  return followed.empty() ? target : followed;
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

void require_file_name(const fs::path& target) {
  const std::string remedy = "name a file to write";
  if (!target.has_filename()) {
    throw Error(ErrorKind::Configuration, target.string(), "is not a file name", remedy);
  }
  std::error_code ignored;
  const fs::file_status status = fs::status(target, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw Error(ErrorKind::Configuration, target.string(), "exists and is not a regular file",
                remedy);
  }
}

/// Where process numbers mean the same: eight hexadecimal digits of the host and, on Linux, of the
/// namespace of process numbers, which containers on one host do not share.
std::string process_space() {
  std::string of(256, '\0');
  if (::gethostname(of.data(), of.size() - 1) != 0) of = "unknown";
  std::array<char, 64> space{};
  if (::readlink("/proc/self/ns/pid", space.data(), space.size() - 1) > 0) of += space.data();
  std::uint32_t hash = 2166136261U;  // FNV-1a
  for (const char c : of) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  constexpr const char* kDigits = "0123456789abcdef";
  std::string digits;
  for (int shift = 28; shift >= 0; shift -= 4) digits += kDigits[(hash >> shift) & 15U];
  return digits;
}

/// What killed processes left of a target. The temporaries of processes that run stay, and those
/// of other hosts, of which it is not known.
void remove_abandoned(const fs::path& folder, const std::string& before, const std::string& after) {
  std::error_code ignored;
  for (fs::directory_iterator entry(folder, ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(before) || !name.ends_with(after)) continue;
    if (name.size() <= before.size() + after.size()) continue;
    pid_t process = 0;
    const char* last = name.data() + name.size() - after.size();
    const auto [read, problem] = std::from_chars(name.data() + before.size(), last, process);
    if (problem != std::errc() || read != last || process <= 0) continue;
    if (::kill(process, 0) == 0 || errno != ESRCH) continue;
    ::unlink(entry->path().c_str());
  }
}

}  // namespace

CrashSafeFile::CrashSafeFile(const fs::path& target) : target_(without_links(target)) {
  require_file_name(target_);
  const std::string before = "." + target_.filename().string() + ".partial-";
  const std::string after = "-" + process_space();
  remove_abandoned(folder_of(target_), before, after);
  temporary_ = folder_of(target_) / (before + std::to_string(::getpid()) + after);
  ::unlink(temporary_.c_str());  // left by a killed process that had the same number
  descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail("cannot be created", errno);
}

CrashSafeFile::~CrashSafeFile() {
  discard();
}

void CrashSafeFile::write(std::string_view bytes) {
  // One call may write less than asked for, and Linux caps it near 2 GiB.
  constexpr std::size_t kLargestWrite = std::size_t{1} << 30;
  while (!bytes.empty()) {
    const ssize_t written =
        ::write(descriptor_, bytes.data(), std::min(bytes.size(), kLargestWrite));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("cannot be written", errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void CrashSafeFile::reserve(std::uint64_t bytes) {
  const int problem = ::posix_fallocate(descriptor_, 0, static_cast<off_t>(bytes));
  if (problem != 0) fail("cannot be written", problem);
}

void CrashSafeFile::continue_at(std::uint64_t end) {
  const auto offset = static_cast<off_t>(end);
  if (::ftruncate(descriptor_, offset) != 0) fail("cannot be shortened", errno);
  if (::lseek(descriptor_, offset, SEEK_SET) != offset) fail("cannot be written", errno);
}

void CrashSafeFile::commit() {
  if (::fsync(descriptor_) != 0) fail("cannot be put on the disk", errno);
  // close() reports what a network file system held back until now.
  if (::close(std::exchange(descriptor_, -1)) != 0) fail("cannot be closed", errno);
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("cannot get its final name", errno);
  temporary_.clear();
  if (const int problem = sync_folder_of(target_); problem != 0) {
    fail("is written, but its folder cannot be put on the disk", problem);
  }
}

void CrashSafeFile::fail(const char* action, int error_number) {
  discard();
  throw_disk_error(target_, action, error_number);
}

void CrashSafeFile::discard() noexcept {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
}

void write_file_crash_safely(const fs::path& target, std::string_view bytes) {
  CrashSafeFile file(target);
  file.write(bytes);
  file.commit();
}

}  // namespace palpate
