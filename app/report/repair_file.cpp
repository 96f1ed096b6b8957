// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/repair_file.hpp"

#include <algorithm>

#include "app/report/embed.hpp"
#include "format/error.hpp"

namespace palpate::report {
namespace {

using nlohmann::json;

constexpr const char* kKind = "palpate.repair";

json columns(const DistanceMap& map) {
  std::vector<float> points, distance(map.distance.begin(), map.distance.end());
  std::vector<std::int32_t> corners;
  for (const Vec3& x : map.points)
    for (const double c : x) points.push_back(static_cast<float>(c));
  for (const Triangle& t : map.triangles) corners.insert(corners.end(), t.begin(), t.end());
  return {{"points", column(points)},
          {"facets", index_column(corners)},
          {"distance", column(distance)}};
}

bool has_columns(const json& map) {
  return map.is_object() && map.contains("points") && map.contains("facets") &&
         map.contains("distance");
}

bool is_input(const std::string& sha256, const Provenance& body) {
  return std::any_of(body.steps.begin(), body.steps.end(), [&](const ProvenanceStep& step) {
    return std::any_of(step.inputs.begin(), step.inputs.end(),
                       [&](const InputDigest& input) { return input.sha256 == sha256; });
  });
}

}  // namespace

std::string repair_text(const std::string& surface_sha256, const DistanceMap& file,
                        const DistanceMap& repaired) {
  const json all = {{"kind", kKind},
                    {"surface_sha256", surface_sha256},
                    {"file", columns(file)},
                    {"repaired", columns(repaired)}};
  return all.dump(1) + "\n";
}

json repair_data(const std::string& text, const Provenance& body) {
  if (text.empty()) return nullptr;
  const json all = json::parse(text, nullptr, false);
  if (all.is_discarded() || !all.is_object() || all.value("kind", json()) != kKind ||
      !all.value("surface_sha256", json()).is_string() || !has_columns(all.value("file", json())) ||
      !has_columns(all.value("repaired", json()))) {
    throw Error(ErrorKind::Configuration, "repair.json", "this version cannot read it",
                "remove it from the folder, or write it again with `palpate mesh`");
  }
  if (!is_input(all["surface_sha256"].get<std::string>(), body)) return {{"other_surface", true}};
  return {{"file", all["file"]}, {"repaired", all["repaired"]}};
}

}  // namespace palpate::report
