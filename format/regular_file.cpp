// SPDX-License-Identifier: Apache-2.0
#include "format/regular_file.hpp"

#include <system_error>

#include "format/error.hpp"

namespace palpate {

namespace fs = std::filesystem;

std::string other_kind_of_file(const fs::path& path) {
  std::error_code ignored;
  switch (fs::status(path, ignored).type()) {
    case fs::file_type::directory:
      return "a folder";
    case fs::file_type::fifo:
      return "a FIFO";
    case fs::file_type::socket:
      return "a socket";
    case fs::file_type::block:
    case fs::file_type::character:
      return "a device";
    default:
      return "";
  }
}

void require_regular_file(const fs::path& path, const std::string& remedy) {
  const std::string kind = other_kind_of_file(path);
  if (!kind.empty()) refuse(path.string(), "is not a regular file but " + kind, remedy);
}

}  // namespace palpate
