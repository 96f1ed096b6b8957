// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/calibration_files.hpp"

#include <fmt/format.h>

#include "app/pipeline/workspace.hpp"
#include "app/report/report.hpp"
#include "format/crash_safe_file.hpp"

namespace palpate::app {

using Json = nlohmann::ordered_json;

namespace {

/// A row and a column for each constant.
std::string correlations_csv(const Json& account) {
  std::string text;
  for (const Json& constant : account["constants"])
    text += ",\"" + constant["name"].get<std::string>() + '"';
  text += '\n';
  for (std::size_t i = 0; i < account["correlation"].size(); ++i) {
    text += '"' + account["constants"][i]["name"].get<std::string>() + '"';
    for (const Json& value : account["correlation"][i])
      text += value.is_null() ? "," : fmt::format(",{:.6g}", value.get<double>());
    text += '\n';
  }
  return text;
}

}  // namespace

std::string write_calibration_files(const Json& account, const std::filesystem::path& folder,
                                    bool page) {
  prepare_output(folder);
  write_file_crash_safely(folder / "calibration.json", account.dump(2) + "\n");
  write_file_crash_safely(folder / "correlations.csv", correlations_csv(account));
  std::string names = (folder / "calibration.json").string() + ", correlations.csv";
  if (!page) return names;
  report::write_calibration(account.dump(), folder / "calibration.html");
  return names + ", calibration.html";
}

}  // namespace palpate::app
