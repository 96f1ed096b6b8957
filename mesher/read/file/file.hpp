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

/// All bytes of a file. @throws Error(Geometry) as `check_readable`, and for an empty file.
std::string read_bytes(const std::filesystem::path& path);

}  // namespace palpate::mesher
