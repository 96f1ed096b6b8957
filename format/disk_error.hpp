// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace palpate {

/// Throws the error of a system call on a file.
/// @throws Error: Configuration for a folder that cannot contain the file (missing, no
/// permission), Internal when the disk refuses (full, quota, size limit, I/O).
[[noreturn]] void throw_disk_error(const std::filesystem::path& file, const char* action,
                                   int error_number);

/// fsync of the folder of `file`, so that its name survives a power loss. Returns errno.
int sync_folder_of(const std::filesystem::path& file);

}  // namespace palpate
