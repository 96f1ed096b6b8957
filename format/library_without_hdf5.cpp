// SPDX-License-Identifier: Apache-2.0
// The reader of a build without HDF5, in place of library_file.cpp.
#include "format/error.hpp"
#include "format/flat_file.hpp"
#include "format/flat_library.hpp"

namespace palpate {

Library read_library(const std::filesystem::path& path) {
  return read_flat_library(content_of(path), path);
}

Library library_from_bytes(std::string_view bytes) {
  return read_flat_library(bytes, kInMemory);
}

}  // namespace palpate
