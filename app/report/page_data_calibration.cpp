// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/page_data.hpp"
#include "format/error.hpp"

namespace palpate::report {

nlohmann::json calibration_data(const std::string& text) {
  if (text.empty()) return nullptr;
  nlohmann::json data = nlohmann::json::parse(text, nullptr, false);
  const bool known = !data.is_discarded() && data.is_object() &&
                     data.value("artifact", "") == "palpate.calibration" &&
                     data.value("schema", 0) == 1 && data.contains("constants") &&
                     (data.contains("tests") || data.contains("paths") || data.contains("records"));
  if (!known)
    throw Error(ErrorKind::Configuration, "calibration.json", "this version cannot read it",
                "write it again with `palpate calibrate`, or remove it from the folder");
  return data;
}

void write_calibration(const std::string& text, const std::filesystem::path& path) {
  const nlohmann::json calibration = calibration_data(text);
  write_page({{"title", calibration.value("name", "calibration")}, {"calibration", calibration}},
             path);
}

}  // namespace palpate::report
