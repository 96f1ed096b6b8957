// SPDX-License-Identifier: Apache-2.0
// A file that grows by whole records and survives a crash. Each record is its length
// (uint32), its bytes, and their SHA-256 in 64 hexadecimal digits: an incomplete
// record is recognised.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace palpate {

inline constexpr std::size_t kDigestDigits = 64;

/// `payload` as a record, with its length and digest.
std::string record_of(std::string_view payload);

/// Removes a whole record from the front of `bytes`; false when there is none.
bool take_record(std::string_view& bytes, std::string_view& payload);

/// Held by one process at a time (flock). Not thread-safe.
class RecordFile {
 public:
  /// Opens the file or makes it. @throws Error when the disk refuses, or Configuration with `busy`
  /// and `remedy` when another process holds it.
  RecordFile(const std::filesystem::path& path, const char* busy, const char* remedy);
  ~RecordFile();
  RecordFile(RecordFile&& other) noexcept;
  RecordFile& operator=(RecordFile&& other) noexcept;

  const std::filesystem::path& path() const { return path_; }

  /// Drops what follows the first `end` bytes; the next bytes go there.
  void cut(std::uint64_t end);
  /// When the disk refuses, the file is as it was before.
  void append(std::string_view bytes);
  void append_durably(std::string_view bytes);  ///< the same, on the disk when it returns
  void synchronize();                           ///< what was appended is on the disk
  void remove();
  void rename(const std::filesystem::path& to);

 private:
  void write_behind_end(std::string_view bytes);
  [[noreturn]] void refuse(const char* action);

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t end_ = 0;
};

}  // namespace palpate
