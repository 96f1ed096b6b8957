// SPDX-License-Identifier: Apache-2.0
// A file that is either wholly there or not there at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace palpate {

/// Writes a file under the temporary name `.<name>.partial-<pid>-<host>` in the folder of the
/// target and gives it its final name only in commit(), after its bytes are on the disk. Whatever
/// happens before, a previous file of that name stays as it was. Destroying an uncommitted file
/// removes the temporary; one that a killed process left is removed by the next that writes the
/// target on the same host (on Windows by none). A symbolic link as target is followed, so the link
/// survives.
///
/// Every failure is an Error: Configuration for a target that cannot be a file (folder missing, no
/// permission, not a regular file), Internal when the disk refuses (full, quota, size limit, I/O).
/// Not thread-safe; two objects of one process must not write the same target at a time.
class CrashSafeFile {
 public:
  explicit CrashSafeFile(const std::filesystem::path& target);
  ~CrashSafeFile();
  CrashSafeFile(const CrashSafeFile&) = delete;
  CrashSafeFile& operator=(const CrashSafeFile&) = delete;

  void write(std::string_view bytes);

  /// For who writes into the temporary by other means: where it is; room on the disk for so many
  /// bytes, so that a full disk is met here and not later; the end of what was written, where
  /// write() goes on.
  const std::filesystem::path& temporary() const { return temporary_; }
  void reserve(std::uint64_t bytes);
  void continue_at(std::uint64_t end);

  void commit();  ///< fsync, rename, fsync of the folder

 private:
  [[noreturn]] void fail(const char* action, int error_number);
  void discard() noexcept;

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
};

/// All of it in one call. @throws Error as CrashSafeFile.
void write_file_crash_safely(const std::filesystem::path& target, std::string_view bytes);

}  // namespace palpate
