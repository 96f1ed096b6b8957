// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/zip_archive.hpp"

#include <minizip/unzip.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <system_error>

#include "format/error.hpp"

namespace palpate::measured {
namespace {

constexpr std::uint64_t kLargestMember = std::uint64_t{1} << 29;
constexpr std::size_t kPiece = std::size_t{1} << 20;

}  // namespace

ZipArchive::ZipArchive(const std::filesystem::path& path)
    : path_(path), archive_(unzOpen64(path.c_str())) {
  if (archive_ == nullptr)
    refuse(path.string(), "the archive has no table of contents", "it was cut off: copy it again");
}

ZipArchive::~ZipArchive() {
  unzClose(archive_);
}

std::optional<std::string> ZipArchive::member(const std::string& name) const {
  constexpr int kCaseMatters = 1;
  if (unzLocateFile(archive_, name.c_str(), kCaseMatters) != UNZ_OK) return std::nullopt;
  const std::string where = path_.string() + ", " + name;
  unz_file_info64 info{};
  const bool opened =
      unzGetCurrentFileInfo64(archive_, &info, nullptr, 0, nullptr, 0, nullptr, 0) == UNZ_OK &&
      unzOpenCurrentFile(archive_) == UNZ_OK;
  if (!opened) refuse(where, "it cannot be opened", "save the file again, without a password");
  std::string content;
  std::string piece(kPiece, '\0');
  int count = 0;
  while ((count = unzReadCurrentFile(archive_, piece.data(), kPiece)) > 0 &&
         content.size() <= kLargestMember)
    content.append(piece, 0, static_cast<std::size_t>(count));
  // The checksum is compared only where as much was unpacked as was packed.
  const bool whole = unzCloseCurrentFile(archive_) == UNZ_OK && count == 0 &&
                     content.size() == info.uncompressed_size;
  if (content.size() > kLargestMember)
    refuse(where, "it is larger than half a gigabyte", "save the sheet as CSV");
  if (!whole) refuse(where, "it is damaged", "copy or save the file again");
  return content;
}

}  // namespace palpate::measured
