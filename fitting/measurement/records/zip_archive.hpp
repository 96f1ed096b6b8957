// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace palpate::measured {

/// A ZIP archive that is read file by file.
class ZipArchive {
 public:
  /// @throws Error(Configuration) for what is no archive, or is cut off.
  explicit ZipArchive(const std::filesystem::path& path);
  ~ZipArchive();
  ZipArchive(const ZipArchive&) = delete;
  ZipArchive& operator=(const ZipArchive&) = delete;

  /// The content of a member, its checksum verified; none where there is no such member.
  /// @throws Error(Configuration) for a damaged member, or one of more than half a gigabyte.
  std::optional<std::string> member(const std::string& name) const;

 private:
  std::filesystem::path path_;
  void* archive_ = nullptr;
};

}  // namespace palpate::measured
