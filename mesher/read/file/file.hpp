// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace palpate::mesher {

/// The remedy for a file whose content contradicts itself.
inline constexpr const char* kDamagedFile = "the file is damaged: export it again";

/// ASCII letters in lower case.
std::string lower(std::string word);

/// The ending of a file name in lower case, ".gz" together with the one before it: ".nii.gz".
std::string ending(const std::filesystem::path& path);

/// @throws Error(Geometry) where the path is missing, no regular file or not readable.
void check_readable(const std::filesystem::path& path);

/// Throws Error(Geometry) for a file whose ending is that of no reader.
/// @param what   for the message: "surface file"
/// @param kinds  that are read, for the remedy
[[noreturn]] void refuse_kind(const std::filesystem::path& path, const std::string& what,
                              const std::string& kinds);

/// All bytes of a file. @throws Error(Geometry) as `check_readable`, and for an empty file.
std::string read_bytes(const std::filesystem::path& path);

}  // namespace palpate::mesher
