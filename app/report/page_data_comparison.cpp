// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/page_data.hpp"
#include "format/error.hpp"

namespace palpate::report {
namespace {

[[noreturn]] void refuse_comparison(const char* problem) {
  throw Error(ErrorKind::Configuration, "comparison.json", problem,
              "write it again with `palpate compare`, or remove it from the folder");
}

}  // namespace

nlohmann::json comparison_data(const std::string& text, std::size_t vertices) {
  if (text.empty()) return nullptr;
  nlohmann::json data = nlohmann::json::parse(text, nullptr, false);
  if (data.is_discarded() || !data.is_object() ||
      data.value("artifact", "") != "palpate.comparison" || data.value("schema", 0) != 1) {
    refuse_comparison("this version cannot read it");
  }
  if (!data.contains("curves") || !data["curves"].is_array()) refuse_comparison("it has no curves");
  for (const auto& curve : data["curves"]) {
    const auto vertex = curve.value("vertex", -1);
    if (vertex < 0 || static_cast<std::size_t>(vertex) >= vertices) {
      refuse_comparison("a vertex in it is not in the library");
    }
  }
  return data;
}

}  // namespace palpate::report
