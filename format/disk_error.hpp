// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace palpate {

/// What the system refused, with its reason and what to do about it.
/// @throws Error: Configuration for a place that cannot hold the file (folder missing, no
/// permission), Internal when the disk refuses (full, quota, size limit, I/O).
[[noreturn]] void throw_disk_error(const std::filesystem::path& file, const char* action,
                                   int error_number);

/// fsync of the folder that holds `file`, so that its name survives a power loss. Returns errno.
int sync_folder_of(const std::filesystem::path& file);

}  // namespace palpate
