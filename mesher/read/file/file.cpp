// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/file/file.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <system_error>

#include "format/error.hpp"

namespace palpate::mesher {

std::string lower(std::string word) {
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return word;
}

std::string ending(const std::filesystem::path& path) {
  const std::string last = lower(path.extension().string());
  return last == ".gz" ? lower(path.stem().extension().string()) + last : last;
}

void refuse_kind(const std::filesystem::path& path, const std::string& what,
                 const std::string& kinds) {
  const std::string kind = ending(path), where = path.string();
  if (kind.ends_with(".gz"))
    refuse_geometry(where, "a compressed " + what + " is not read",
                    "unpack it: gunzip \"" + where + "\"");
  if (kind.empty()) {
    refuse_geometry(where, "its name has no ending that says which kind of " + what + " it is",
                    "give it the ending of its kind: " + kinds);
  }
  refuse_geometry(where, "unknown kind of " + what + " '" + kind + "'", "convert it to " + kinds);
}

void check_readable(const std::filesystem::path& path) {
  const std::string where = path.string();
  std::error_code failure;
  if (!std::filesystem::exists(path, failure)) {
    throw Error(ErrorKind::Configuration, where, "no such file", "correct the path");
  }
  if (!std::filesystem::is_regular_file(path, failure) || !std::ifstream(path)) {
    throw Error(ErrorKind::Configuration, where, "not a readable file",
                "check its type and its permissions");
  }
}

std::string read_bytes(const std::filesystem::path& path) {
  check_readable(path);
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  const auto size = in.tellg();
  if (size == std::ifstream::pos_type(0)) {
    refuse_geometry(path.string(), "the file is empty", "export it again");
  }
  std::string bytes(static_cast<std::size_t>(size), '\0');
  in.seekg(0);
  if (!in.read(bytes.data(), size)) {
    refuse_geometry(path.string(), "the file cannot be read to its end", "check the disk");
  }
  return bytes;
}

}  // namespace palpate::mesher
