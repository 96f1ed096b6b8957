// SPDX-License-Identifier: Apache-2.0
#include "format/site_record.hpp"

#include <utility>

#include "format/bytes.hpp"
#include "format/sha256.hpp"

namespace palpate {
namespace {

constexpr std::size_t kSampleBytes = 17 * sizeof(double) + sizeof(std::int32_t);
constexpr std::size_t kSmallestPathBytes =
    1 + 5 * sizeof(double) + sizeof(std::int32_t) + sizeof(std::uint32_t);

void put(ByteWriter& out, const CurveSample& s) {
  out.put(s.displacement);
  out.put(s.force);
  for (const double value :
       {s.strain_energy, s.tool_work, s.min_jacobian, s.penetration, s.contact_area})
    out.put(value);
  out.put(s.iterations);
  for (const double value : {s.force_scatter, s.force_uncertainty, s.contact_energy, s.tension,
                             s.facets_in_contact, s.mesh_difference, s.mesh_error, s.volume_change})
    out.put(value);
}

CurveSample sample_of(ByteReader& in) {
  CurveSample s;
  s.displacement = in.get<double>();
  s.force = in.vector();
  for (double* value :
       {&s.strain_energy, &s.tool_work, &s.min_jacobian, &s.penetration, &s.contact_area})
    *value = in.get<double>();
  s.iterations = in.get<std::int32_t>();
  for (double* value : {&s.force_scatter, &s.force_uncertainty, &s.contact_energy, &s.tension,
                        &s.facets_in_contact, &s.mesh_difference, &s.mesh_error, &s.volume_change})
    *value = in.get<double>();
  return s;
}

void put(ByteWriter& out, const CurvePath& path) {
  out.put(static_cast<std::uint8_t>(path.kind));
  out.put(path.lateral_depth);
  out.put(path.direction);
  out.put(path.repeats);
  out.put(path.contact_uncertainty);
  out.put(static_cast<std::uint32_t>(path.samples.size()));
  for (const CurveSample& sample : path.samples) put(out, sample);
}

CurvePath path_of(ByteReader& in) {
  CurvePath path;
  path.kind = in.one_of(PathKind::Lateral);
  path.lateral_depth = in.get<double>();
  path.direction = in.vector();
  path.repeats = in.get<std::int32_t>();
  path.contact_uncertainty = in.get<double>();
  path.samples.resize(in.count(kSampleBytes));
  for (CurveSample& sample : path.samples) sample = sample_of(in);
  return path;
}

std::size_t regions_of(const SiteCurves& site) {
  for (const CurvePath& path : site.paths)
    for (const CurveSample& sample : path.samples) return sample.isochoric_energy.size();
  return 0;
}

/// Nothing for elastic tissue.
void put_energies(ByteWriter& out, const SiteCurves& site) {
  const std::size_t regions = regions_of(site);
  if (regions == 0) return;
  out.put(static_cast<std::uint32_t>(regions));
  for (const CurvePath& path : site.paths)
    for (const CurveSample& sample : path.samples)
      for (std::size_t r = 0; r < regions; ++r) out.put(sample.isochoric_energy.at(r));
}

void take_energies(ByteReader& in, SiteCurves& site) {
  if (in.at_end()) return;
  const std::size_t regions = in.count(sizeof(double));
  for (CurvePath& path : site.paths)
    for (CurveSample& sample : path.samples)
      for (std::size_t r = 0; r < regions; ++r) sample.isochoric_energy.push_back(in.get<double>());
}

}  // namespace

std::string site_bytes(const SiteCurves& site) {
  ByteWriter out;
  out.put(site.vertex);
  out.put(static_cast<std::uint8_t>(site.status));
  out.put(site.reason);
  out.put(site.cpu_seconds);
  out.put(static_cast<std::uint32_t>(site.paths.size()));
  for (const CurvePath& path : site.paths) put(out, path);
  put_energies(out, site);
  return std::move(out.bytes);
}

SiteCurves site_from_bytes(std::string_view bytes, const std::string& where) {
  ByteReader in(bytes, where, "holds a record that is no site",
                "remove the file and run `palpate precompute` again");
  SiteCurves site;
  site.vertex = in.get<std::int32_t>();
  site.status = in.one_of(SiteStatus::Failed);
  site.reason = in.text();
  site.cpu_seconds = in.get<double>();
  site.paths.resize(in.count(kSmallestPathBytes));
  for (CurvePath& path : site.paths) path = path_of(in);
  take_energies(in, site);
  in.expect_end();
  return site;
}

std::string content_sha256(const Curves& curves) {
  ByteWriter out;
  out.put(curves.tool.shape);
  out.put(curves.tool.radius);
  out.put(curves.tool.friction);
  out.put(curves.tool.edge_radius);
  out.put(curves.tool.length);
  out.put(curves.depth);
  out.put(curves.lateral_travel);
  for (const double time : curves.relaxation.times_s) out.put(time);
  for (const std::vector<double>& region : curves.relaxation.fractions)
    for (const double fraction : region) out.put(fraction);
  for (SiteCurves site : curves.sites) {
    site.cpu_seconds = 0;
    out.bytes += site_bytes(site);
  }
  return sha256(out.bytes);
}

}  // namespace palpate
