// SPDX-License-Identifier: Apache-2.0
// CrashSafeFile on Windows, in place of crash_safe_file.cpp.
#define WIN32_LEAN_AND_MEAN
#define NOMINMAX
#include <fcntl.h>
#include <io.h>
#include <process.h>
#include <sys/stat.h>
#include <windows.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <utility>

#include "format/crash_safe_file.hpp"
#include "format/disk_error.hpp"
#include "format/regular_file.hpp"

namespace palpate {

CrashSafeFile::CrashSafeFile(const std::filesystem::path& target) : target_(target) {
  require_regular_file(target_, "name a file to write");
  const std::string suffix = ".partial-" + std::to_string(_getpid());
  temporary_ = target_.parent_path() / ("." + target_.filename().string() + suffix);
  _wunlink(temporary_.c_str());  // left by a killed process that had the same number
  descriptor_ =
      _wopen(temporary_.c_str(), _O_WRONLY | _O_CREAT | _O_EXCL | _O_BINARY, _S_IREAD | _S_IWRITE);
  if (descriptor_ < 0) fail("cannot be created", errno);
}

CrashSafeFile::~CrashSafeFile() {
  discard();
}

void CrashSafeFile::write(std::string_view bytes) {
  constexpr std::size_t kLargestWrite = std::size_t{1} << 30;
  while (!bytes.empty()) {
    const auto size = static_cast<unsigned>(std::min(bytes.size(), kLargestWrite));
    const int written = _write(descriptor_, bytes.data(), size);
    if (written < 0) fail("cannot be written", errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void CrashSafeFile::reserve(std::uint64_t bytes) {
  const int problem = _chsize_s(descriptor_, static_cast<std::int64_t>(bytes));
  if (problem != 0) fail("cannot be written", problem);
}

void CrashSafeFile::continue_at(std::uint64_t end) {
  const auto offset = static_cast<std::int64_t>(end);
  if (const int problem = _chsize_s(descriptor_, offset); problem != 0)
    fail("cannot be shortened", problem);
  if (_lseeki64(descriptor_, offset, SEEK_SET) != offset) fail("cannot be written", errno);
}

void CrashSafeFile::commit() {
  if (_commit(descriptor_) != 0) fail("cannot be put on the disk", errno);
  if (_close(std::exchange(descriptor_, -1)) != 0) fail("cannot be closed", errno);
  if (MoveFileExW(temporary_.c_str(), target_.c_str(),
                  MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) == 0)
    fail("cannot get its final name", EACCES);
  temporary_.clear();
}

void CrashSafeFile::fail(const char* action, int error_number) {
  discard();
  throw_disk_error(target_, action, error_number);
}

void CrashSafeFile::discard() noexcept {
  if (descriptor_ >= 0) _close(std::exchange(descriptor_, -1));
  if (!temporary_.empty()) _wunlink(temporary_.c_str());
  temporary_.clear();
}

void write_file_crash_safely(const std::filesystem::path& target, std::string_view bytes) {
  CrashSafeFile file(target);
  file.write(bytes);
  file.commit();
}

}  // namespace palpate
