// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace palpate::app {

/// Write calibration.json, correlations.csv (a row and a column for each constant) and, if wanted,
/// calibration.html to a folder. @return their names, in one line.
std::string write_calibration_files(const nlohmann::ordered_json& account,
                                    const std::filesystem::path& folder, bool page = true);

}  // namespace palpate::app
