// SPDX-License-Identifier: AGPL-3.0-or-later
// What is named on the command line of `palpate import`: a sidecar, records, or both.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace palpate::app {

struct ImportRequest {
  std::filesystem::path sidecar;
  std::vector<std::filesystem::path> records;  ///< empty: all of the sidecar
};

/// Patterns are replaced by the files that match. Where records are named without a sidecar it is
/// the only TOML file of their folder that
/// names columns.
/// @throws Error(Configuration): several sidecars, records without one, a pattern without a match.
ImportRequest import_request(const std::vector<std::string>& inputs);

}  // namespace palpate::app
