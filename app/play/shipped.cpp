// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/play/shipped.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>

#include "format/error.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

/// The comment lines that open the file, as one text.
std::string opening_comment(const fs::path& file) {
  std::ifstream stream(file);
  std::string text;
  for (std::string line; std::getline(stream, line) && line.starts_with("# ");)
    if (!line.starts_with("# SPDX")) text += (text.empty() ? "" : " ") + line.substr(2);
  return text;
}

std::string first_sentence(const std::string& text) {
  const std::size_t end = text.find(". ");
  return end == std::string::npos ? text : text.substr(0, end + 1);
}

std::string names_of(const std::vector<ShippedLibrary>& libraries) {
  std::vector<std::string> names;
  for (const ShippedLibrary& library : libraries) names.push_back(library.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

fs::path shipped_folder() {
  std::error_code unknown;
  const fs::path program = fs::read_symlink("/proc/self/exe", unknown);
  return program.parent_path().parent_path() / "share" / "palpate" / "libraries";
}

std::vector<ShippedLibrary> shipped_libraries(const fs::path& folder) {
  std::vector<ShippedLibrary> libraries;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
    const fs::path& file = entry.path();
    if (file.extension() != ".plib") continue;
    const std::string name = file.stem().string();
    const fs::path its_case = folder.parent_path() / "cases" / (name + ".toml");
    libraries.push_back({name, file, first_sentence(opening_comment(its_case))});
  }
  std::sort(libraries.begin(), libraries.end(),
            [](const ShippedLibrary& a, const ShippedLibrary& b) { return a.name < b.name; });
  return libraries;
}

fs::path chosen_library(const std::string& word, const fs::path& shipped) {
  const std::vector<ShippedLibrary> libraries = shipped_libraries(shipped);
  for (const ShippedLibrary& library : libraries)
    if (library.name == word) return library.file;
  fs::path path = word;
  if (!fs::is_directory(path)) {
    if (fs::exists(path)) return path;
    refuse(word, "there is no such library",
           "name a library.h5, a .plib, a folder that has one" +
               (libraries.empty()
                    ? ""
                    : ", or one of those that come with palpate: " + names_of(libraries)));
  }
  for (const char* file : {"library.h5", "library.plib"})
    if (fs::exists(path / file)) return path / file;
  refuse(word, "it has neither library.h5 nor library.plib",
         "run `palpate build` into this folder");
}

}  // namespace palpate::app
