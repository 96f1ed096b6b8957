// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/measured/request.hpp"

#include <algorithm>
#include <fstream>
#include <string>
#include <system_error>

#include "app/measured/file_pattern.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(const std::string& input) {
  std::error_code none;
  if (!is_pattern(input) || fs::exists(input, none)) return {input};
  std::vector<fs::path> files;
  for (const MatchedFile& match : matching_files("", input, "command line"))
    files.push_back(match.file);
  return files;
}

bool is_sidecar(const fs::path& file) {
  return file.extension() == ".toml";
}

/// A case lies there as well: a sidecar has the names of columns.
bool names_columns(const fs::path& file) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);)
    if (line.find("[columns]") != std::string::npos) return true;
  return false;
}

/// The only sidecar beside a record.
fs::path sidecar_beside(const fs::path& record) {
  const fs::path folder = record.has_parent_path() ? record.parent_path() : fs::path(".");
  std::vector<fs::path> found;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
    if (is_sidecar(entry.path()) && names_columns(entry.path())) found.push_back(entry.path());
  if (found.size() == 1) return found.front();
  std::sort(found.begin(), found.end());
  std::string names;
  for (const fs::path& file : found)
    names += (names.empty() ? "" : ", ") + file.filename().string();
  if (found.empty())
    refuse(record.string(), "this is a record, not its sidecar, and none lies beside it",
           "describe it in a TOML file beside it, as data/measured/pad/presses.toml does "
           "(docs/measured.md), and give that file");
  refuse(record.string(), "several sidecars lie beside it: " + names,
         "name one of them in front of the records");
}

}  // namespace

ImportRequest import_request(const std::vector<std::string>& inputs) {
  ImportRequest request;
  for (const std::string& input : inputs)
    for (const fs::path& file : files_of(input)) {
      if (!is_sidecar(file)) {
        request.records.push_back(file);
        continue;
      }
      if (!request.sidecar.empty())
        refuse(file.string(), "two sidecars are named", "import them one after the other");
      request.sidecar = file;
    }
  if (request.sidecar.empty()) request.sidecar = sidecar_beside(request.records.front());
  return request;
}

}  // namespace palpate::app
