// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/page_data.hpp"
#include "format/error.hpp"

namespace palpate::report {
namespace {

using nlohmann::json;

[[noreturn]] void refuse_fidelity(const char* problem) {
  throw Error(ErrorKind::Configuration, "fidelity.json", problem,
              "write it again with `palpate compare --fem`, or remove it from the folder");
}

bool is_row(const json& row) {
  return row.is_object() && row.value("what", json()).is_string() &&
         row.value("part", json()).is_string() && row.value("states", json()).is_number() &&
         row.value("median", json()).is_number() && row.value("p95", json()).is_number() &&
         row.value("worst", json()).is_number();
}

std::size_t points_at_nodes(const json& points) {
  std::size_t count = 0;
  for (const json& point : points) count += point.value("at_node", false) ? 1 : 0;
  return count;
}

}  // namespace

json fidelity_data(const std::string& text, const std::string& library_sha256) {
  if (text.empty()) return nullptr;
  const json fidelity = json::parse(text, nullptr, false);
  if (fidelity.is_discarded() || !fidelity.is_object() ||
      fidelity.value("kind", json()) != "palpate.fidelity" || !fidelity.contains("points") ||
      !fidelity.contains("libraries") || !fidelity["libraries"].is_array()) {
    refuse_fidelity("this version cannot read it");
  }
  for (const json& library : fidelity["libraries"]) {
    if (library.value("sha256", "") != library_sha256) continue;
    const json rows = library.value("rows", json::array());
    for (const json& row : rows)
      if (!is_row(row)) refuse_fidelity("a row is incomplete");
    const std::size_t at_nodes = points_at_nodes(fidelity["points"]);
    return {{"floor", fidelity.value("floor_N", 0.0)},
            {"friction", fidelity.value("friction", 0.0)},
            {"off_node", fidelity["points"].size() - at_nodes},
            {"at_node", at_nodes},
            {"rows", rows}};
  }
  return {{"other_library", true}};
}

}  // namespace palpate::report
