// SPDX-License-Identifier: Apache-2.0
#include "format/deformation.hpp"

#include <algorithm>
#include <cmath>

#include "format/checks.hpp"
#include "format/crash_safe_file.hpp"
#include "format/flat_file.hpp"
#include "format/flat_library.hpp"
#include "format/sha256.hpp"

namespace palpate {
namespace {

constexpr const char* kKind = "palpate.deformation";
constexpr const char* kRemedy = "make it again: 'palpate fit' writes it beside the library";
constexpr double kUnit = 1e-6;  // tolerance of unit vectors and of weights that sum to 1

template <class Numbers>
void require_finite(const FlatReader& reader, const std::string& name, const Numbers& numbers) {
  if (!std::all_of(numbers.begin(), numbers.end(), [](auto x) { return std::isfinite(x); }))
    reader.fail(name, "has a number that is not finite");
}

std::vector<double> ascending(const FlatReader& reader, const std::string& name) {
  auto values = reader.array<double>(name);
  require_finite(reader, name, values);
  for (std::size_t i = 1; i < values.size(); ++i)
    if (!(values[i] > values[i - 1])) reader.fail(name, "does not ascend");
  return values;
}

std::vector<float> numbers(const FlatReader& reader, const std::string& name, std::size_t count) {
  auto values = reader.array<float>(name, count);
  require_finite(reader, name, values);
  return values;
}

template <class Rows>
void require_rows_below(const FlatReader& reader, const std::string& name, const Rows& rows,
                        std::size_t count) {
  for (const auto row : rows)
    if (row < 0 || static_cast<std::size_t>(row) >= count)
      reader.fail(name, "refers to row " + std::to_string(row) + " of " + std::to_string(count));
}

void put_sites(FlatWriter& writer, const Deformation& d) {
  std::vector<Vec3> positions, inwards, tangents;
  for (const SiteFrame& site : d.sites) {
    positions.push_back(site.position);
    inwards.push_back(site.inward);
    tangents.push_back(site.tangent);
  }
  writer.array("/site/position", positions);
  writer.array("/site/inward", inwards);
  writer.array("/site/tangent", tangents);
}

void get_sites(const FlatReader& reader, Deformation& d) {
  const auto positions = reader.array<Vec3>("/site/position");
  const auto inwards = reader.array<Vec3>("/site/inward", positions.size());
  const auto tangents = reader.array<Vec3>("/site/tangent", positions.size());
  for (std::size_t s = 0; s < positions.size(); ++s) {
    require_finite(reader, "/site/position", positions[s]);
    const bool good = std::abs(norm(inwards[s]) - 1) < kUnit &&
                      std::abs(norm(tangents[s]) - 1) < kUnit &&
                      std::abs(dot(inwards[s], tangents[s])) < kUnit;
    if (!good) reader.fail("/site/inward", "has a frame that is not orthonormal");
    d.sites.push_back({positions[s], inwards[s], tangents[s]});
  }
}

void get_skin(const FlatReader& reader, Deformation& d) {
  d.positions = reader.array<Vec3>("/skin/position");
  for (const Vec3& x : d.positions) require_finite(reader, "/skin/position", x);
  d.triangles = reader.array<Triangle>("/skin/triangles");
  for (const Triangle& t : d.triangles)
    require_rows_below(reader, "/skin/triangles", t, d.positions.size());
  d.vertex_of = reader.array<std::int32_t>("/skin/vertex_of");
  require_rows_below(reader, "/skin/vertex_of", d.vertex_of, d.positions.size());
}

void get_donors(const FlatReader& reader, Deformation& d) {
  d.donor_offset = reader.array<std::int64_t>("/donor/offset", d.vertex_of.size() + 1);
  d.donor = reader.array<std::int32_t>("/donor/site");
  d.donor_weight = numbers(reader, "/donor/weight", d.donor.size());
  require_rows_below(reader, "/donor/site", d.donor, d.sites.size());
  const bool whole = d.donor_offset.front() == 0 &&
                     d.donor_offset.back() == static_cast<std::int64_t>(d.donor.size()) &&
                     std::is_sorted(d.donor_offset.begin(), d.donor_offset.end());
  if (!whole) reader.fail("/donor/offset", "does not divide the donors among the vertices");
  for (std::size_t v = 0; v + 1 < d.donor_offset.size(); ++v) {
    double sum = 0;
    for (std::int64_t i = d.donor_offset[v]; i < d.donor_offset[v + 1]; ++i)
      sum += static_cast<double>(d.donor_weight[static_cast<std::size_t>(i)]);
    if (d.donor_offset[v] != d.donor_offset[v + 1] && !(std::abs(sum - 1) < kUnit * 10))
      reader.fail("/donor/weight", "of vertex " + std::to_string(v) + " do not sum to 1");
  }
}

void get_fields(const FlatReader& reader, Deformation& d) {
  const std::size_t sites = d.sites.size(), depths = d.depths.size(),
                    lateral = d.lateral_depths.size(), knots = d.knots.size();
  d.mode_scale = reader.array<float>("/mode/scale");
  require_finite(reader, "/mode/scale", d.mode_scale);
  const std::size_t modes = d.mode_count();
  d.modes = reader.array<std::int16_t>("/mode/skin", modes * 3 * d.positions.size());
  d.press_local = numbers(reader, "/press/local", sites * depths * kPressComponents * knots);
  d.press_modes = numbers(reader, "/press/modes", sites * depths * modes);
  d.lateral_local = numbers(reader, "/lateral/local", sites * lateral * kLateralComponents * knots);
  d.lateral_modes = numbers(reader, "/lateral/modes", sites * lateral * kTangents * modes);
  if (reader.has("/press/slips")) {
    const auto slips = reader.array<std::uint8_t>("/press/slips", 1);
    Checks(reader).numbers("/press/slips", slips, rules::kFlag);
    d.press_slips = slips.front() == 1;
  }
  if (!reader.has("/lateral/anisotropic")) return;
  d.anisotropic = reader.array<std::int16_t>(
      "/lateral/anisotropic", sites * lateral * kTangents * kAnisotropicComponents * knots);
  d.anisotropic_scale = numbers(reader, "/lateral/anisotropic_scale", sites * lateral);
}

}  // namespace

std::string surface_digest(const std::vector<Vec3>& positions,
                           const std::vector<Triangle>& triangles) {
  std::string bytes(reinterpret_cast<const char*>(positions.data()),
                    positions.size() * sizeof(Vec3));
  bytes.append(reinterpret_cast<const char*>(triangles.data()),
               triangles.size() * sizeof(Triangle));
  return sha256(bytes);
}

std::vector<Vec3> inward_normals(const std::vector<Vec3>& positions,
                                 const std::vector<Triangle>& triangles) {
  std::vector<Vec3> normals(positions.size());
  for (const Triangle& t : triangles) {
    const auto corner = [&](std::size_t l) { return positions[static_cast<std::size_t>(t[l])]; };
    const Vec3 inward = cross(corner(2) - corner(0), corner(1) - corner(0));  // twice the area
    for (const std::int32_t v : t) {
      Vec3& sum = normals[static_cast<std::size_t>(v)];
      sum = sum + inward;
    }
  }
  for (Vec3& n : normals) {
    const double length = norm(n);
    n = length > 0 ? (1.0 / length) * n : Vec3{};
  }
  return normals;
}

void write_deformation(const std::filesystem::path& file, const Deformation& d) {
  FlatWriter writer;
  writer.texts("/words", {kKind, d.surface, d.tool_shape});
  writer.array("/tool", std::vector<double>{d.tool_radius, d.tool_edge_radius});
  writer.array("/sizes", std::vector<double>{d.reach, d.rms_left_out});
  writer.array("/skin/position", d.positions);
  writer.array("/skin/triangles", d.triangles);
  writer.array("/skin/vertex_of", d.vertex_of);
  put_sites(writer, d);
  writer.array("/donor/offset", d.donor_offset);
  writer.array("/donor/site", d.donor);
  writer.array("/donor/weight", d.donor_weight);
  writer.array("/press/depth", d.depths);
  if (d.press_slips) writer.array("/press/slips", std::vector<std::uint8_t>{1});
  writer.array("/press/local", d.press_local);
  writer.array("/press/modes", d.press_modes);
  writer.array("/lateral/depth", d.lateral_depths);
  writer.array("/lateral/local", d.lateral_local);
  writer.array("/lateral/modes", d.lateral_modes);
  if (!d.anisotropic.empty()) {
    writer.array("/lateral/anisotropic", d.anisotropic);
    writer.array("/lateral/anisotropic_scale", d.anisotropic_scale);
  }
  writer.array("/local/knot", d.knots);
  writer.array("/mode/scale", d.mode_scale);
  writer.array("/mode/skin", d.modes);
  write_file_crash_safely(file, writer.file());
}

Deformation read_deformation(std::string_view bytes, const std::filesystem::path& file) {
  const FlatReader reader(bytes, file, kRemedy);
  Deformation d;
  const auto words = reader.texts("/words");
  if (words.size() != 3 || words[0] != kKind)
    reader.fail("/words", "says that this is not a deformation file (deformation.pdef)");
  d.surface = words[1];
  d.tool_shape = words[2];
  const auto tool = reader.array<double>("/tool", 2), sizes = reader.array<double>("/sizes", 2);
  require_finite(reader, "/tool", tool);
  require_finite(reader, "/sizes", sizes);
  d.tool_radius = tool[0];
  d.tool_edge_radius = tool[1];
  d.reach = sizes[0];
  d.rms_left_out = sizes[1];
  get_skin(reader, d);
  get_sites(reader, d);
  get_donors(reader, d);
  d.depths = ascending(reader, "/press/depth");
  d.lateral_depths = ascending(reader, "/lateral/depth");
  d.knots = ascending(reader, "/local/knot");
  if (d.depths.empty() || !(d.depths.front() > 0)) reader.fail("/press/depth", "has no depth");
  if (d.knots.size() < 2 || d.knots.front() != 0 || d.knots.back() != d.reach)
    reader.fail("/local/knot", "does not run from 0 to the reach");
  get_fields(reader, d);
  return d;
}

Deformation read_deformation(const std::filesystem::path& file) {
  return read_deformation(content_of(file), file);
}

}  // namespace palpate
