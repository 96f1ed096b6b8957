// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/repair_file.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "app/report/embed.hpp"
#include "format/base64.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"

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

[[noreturn]] void refuse_repair() {
  throw Error(ErrorKind::Configuration, "repair.json", "this version cannot read it",
              "remove it from the folder, or write it again with `palpate mesh`");
}

template <class T>
std::vector<double> numbers_of(const std::string& bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return {values.begin(), values.end()};
}

/// The numbers of a column that embed.hpp wrote.
std::vector<double> numbers(const json& column) {
  if (!column.is_object() || column.size() != 1 || !column.front().is_string()) refuse_repair();
  const std::optional<std::string> bytes = from_base64(column.front().get<std::string>());
  const std::string type = column.begin().key();
  if (!bytes) refuse_repair();
  if (type == "f4") return numbers_of<float>(*bytes);
  if (type == "u2") return numbers_of<std::uint16_t>(*bytes);
  if (type == "u4") return numbers_of<std::uint32_t>(*bytes);
  if (type == "i4") return numbers_of<std::int32_t>(*bytes);
  refuse_repair();
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

std::optional<DistanceMap> repaired_surface(const std::string& text, const Provenance& body) {
  const json data = repair_data(text, body);
  if (!data.is_object() || !data.contains("repaired")) return {};
  const json& map = data["repaired"];
  const auto points = numbers(map["points"]), corners = numbers(map["facets"]);
  DistanceMap result;
  result.distance = numbers(map["distance"]);
  for (std::size_t i = 0; i + 2 < points.size(); i += 3)
    result.points.push_back({points[i], points[i + 1], points[i + 2]});
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    result.triangles.push_back({static_cast<std::int32_t>(corners[i]),
                                static_cast<std::int32_t>(corners[i + 1]),
                                static_cast<std::int32_t>(corners[i + 2])});
  bool fits = result.distance.size() == result.points.size() && !result.triangles.empty();
  for (const Triangle& t : result.triangles)
    for (const std::int32_t v : t) fits = fits && v >= 0 && to_index(v) < result.points.size();
  if (!fits) refuse_repair();
  return result;
}

json repair_data(const std::string& text, const Provenance& body) {
  if (text.empty()) return nullptr;
  const json all = json::parse(text, nullptr, false);
  if (all.is_discarded() || !all.is_object() || all.value("kind", json()) != kKind ||
      !all.value("surface_sha256", json()).is_string() || !has_columns(all.value("file", json())) ||
      !has_columns(all.value("repaired", json()))) {
    refuse_repair();
  }
  if (!is_input(all["surface_sha256"].get<std::string>(), body)) return {{"other_surface", true}};
  return {{"file", all["file"]}, {"repaired", all["repaired"]}};
}

}  // namespace palpate::report
