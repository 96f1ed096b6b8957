// SPDX-License-Identifier: Apache-2.0
#include "format/crash_safe_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
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

}  // namespace

CrashSafeFile::CrashSafeFile(const fs::path& target) : target_(without_links(target)) {
  require_file_name(target_);
  std::string name = ".";
  name.append(target_.filename().string()).append(".partial-").append(std::to_string(::getpid()));
  temporary_ = folder_of(target_) / name;
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
