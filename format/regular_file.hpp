// SPDX-License-Identifier: Apache-2.0
// Files that can be read to their end: opening a FIFO waits for a writer, and a device has no end.
#pragma once

#include <filesystem>
#include <string>

namespace palpate {

/// What the path names instead of a regular file: "a folder", "a FIFO", "a socket", "a device".
/// Empty for a regular file and where there is nothing.
std::string other_kind_of_file(const std::filesystem::path& path);

/// @throws Error(Configuration) when the path names something else than a regular file.
void require_regular_file(const std::filesystem::path& path, const std::string& remedy);

}  // namespace palpate
