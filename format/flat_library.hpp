// SPDX-License-Identifier: Apache-2.0
// A response library as a flat file, for programs without HDF5. Normative page:
// format/schema/flat.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "format/library.hpp"

namespace palpate {

/// The bytes of the file: everything of the library, provenance included, so that a library read
/// from it is the same to the bit.
/// @throws Error(Internal) where the library is not valid.
std::string flat_bytes(const Library& library, const std::filesystem::path& target);

/// @throws Error as flat_bytes and CrashSafeFile.
void write_flat_library(const std::filesystem::path& path, const Library& library);

/// Read and check as read_library(); `file` is the name in errors.
/// @throws Error(Configuration).
Library read_flat_library(std::string_view bytes, const std::filesystem::path& file);

/// The whole content of a file. @throws Error(Configuration) when it cannot be read.
std::string content_of(const std::filesystem::path& file);

}  // namespace palpate
