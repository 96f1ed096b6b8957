// SPDX-License-Identifier: Apache-2.0
#include "format/site_fields.hpp"

#include <algorithm>
#include <cmath>

#include "format/crash_safe_file.hpp"
#include "format/flat_file.hpp"
#include "format/flat_library.hpp"
#include "format/to_index.hpp"

namespace palpate {
namespace {

constexpr const char* kKind = "palpate.site_fields";
constexpr const char* kRemedy = "run 'palpate precompute' again";

/// The fields one after the other, cut into equal parts again by the reader.
template <class Field>
std::vector<float> in_line(const std::vector<Field>& fields) {
  std::vector<float> all;
  for (const Field& field : fields) all.insert(all.end(), field.skin.begin(), field.skin.end());
  return all;
}

template <class Field>
void cut(const FlatReader& reader, const std::string& name, std::vector<Field>& fields) {
  const auto all = reader.array<float>(name);
  if (fields.empty()) return;
  if (all.size() % fields.size() != 0) reader.fail(name, "does not divide into equal fields");
  if (!std::all_of(all.begin(), all.end(), [](float u) { return std::isfinite(u); }))
    reader.fail(name, "has a number that is not finite");
  const auto size = static_cast<std::ptrdiff_t>(all.size() / fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(i) * size;
    fields[i].skin.assign(begin, begin + size);
  }
}

}  // namespace

std::filesystem::path fields_file(const std::filesystem::path& folder, std::int32_t vertex) {
  return folder / ("site-" + std::to_string(vertex) + ".fields");
}

void write_site_fields(const std::filesystem::path& file, const SiteFields& fields) {
  FlatWriter writer;
  writer.texts("/kind", {kKind, fields.curves});
  writer.array("/vertex", std::vector<std::int32_t>{fields.vertex});
  std::vector<double> depths, lateral_depths, travels;
  std::vector<Vec3> directions;
  for (const NormalField& field : fields.normal) depths.push_back(field.depth);
  for (const LateralField& field : fields.lateral) {
    lateral_depths.push_back(field.depth);
    travels.push_back(field.travel);
    directions.push_back(field.direction);
  }
  writer.array("/normal/depth", depths);
  writer.array("/normal/skin", in_line(fields.normal));
  writer.array("/lateral/depth", lateral_depths);
  writer.array("/lateral/travel", travels);
  writer.array("/lateral/direction", directions);
  writer.array("/lateral/skin", in_line(fields.lateral));
  write_file_crash_safely(file, writer.file());
}

SiteFields read_site_fields(const std::filesystem::path& file) {
  const std::string bytes = content_of(file);
  const FlatReader reader(bytes, file, kRemedy);
  const auto words = reader.texts("/kind", 2);
  if (words[0] != kKind) reader.fail("/kind", "is '" + words[0] + "', not the fields of a site");
  SiteFields fields;
  fields.curves = words[1];
  fields.vertex = reader.array<std::int32_t>("/vertex", 1).front();
  for (const double depth : reader.array<double>("/normal/depth"))
    fields.normal.push_back({depth, {}});
  const auto depths = reader.array<double>("/lateral/depth");
  const auto travels = reader.array<double>("/lateral/travel", depths.size());
  const auto directions = reader.array<Vec3>("/lateral/direction", depths.size());
  for (std::size_t i = 0; i < depths.size(); ++i)
    fields.lateral.push_back({depths[i], directions[i], travels[i], {}});
  cut(reader, "/normal/skin", fields.normal);
  cut(reader, "/lateral/skin", fields.lateral);
  return fields;
}

}  // namespace palpate
