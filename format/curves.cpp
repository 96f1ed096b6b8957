// SPDX-License-Identifier: Apache-2.0
#include "format/curves.hpp"

#include <limits>

#include "format/artifact.hpp"
#include "format/columns.hpp"

namespace palpate {
namespace {

constexpr const char* kCurvesArtifact = "palpate.curves";
constexpr const char* kCurvesRemedy = "make it again with 'palpate precompute' or 'palpate import'";

/// A site and a path as they lie on disk: their paths and samples are runs of rows elsewhere.
struct SiteRow {
  std::int32_t vertex = -1;
  SiteStatus status = SiteStatus::Failed;
  double cpu_seconds = 0;
  std::int64_t first_path = 0;
  std::int64_t path_count = 0;
};
struct PathRow {
  PathKind kind = PathKind::Normal;
  double lateral_depth = 0;
  Vec3 direction{};
  std::int64_t first_sample = 0;
  std::int64_t sample_count = 0;
  std::int32_t repeats = 0;
  double contact_uncertainty = std::numeric_limits<double>::quiet_NaN();
};

constexpr auto kSiteColumns =
    std::make_tuple(column("vertex", &SiteRow::vertex, "1",
                           "Vertex of the response surface, ascending.", rules::kNonNegative),
                    column("status", &SiteRow::status, "1", "0 complete, 1 partial, 2 failed.",
                           rules::up_to(2, "a status (0, 1 or 2)")),
                    column("cpu_seconds", &SiteRow::cpu_seconds, "s",
                           "Processor time spent on the site.", rules::kNonNegative),
                    column("first_path", &SiteRow::first_path, "1",
                           "Row of /path where the site begins.", rules::kNonNegative),
                    column("path_count", &SiteRow::path_count, "1", "Number of paths of the site.",
                           rules::kNonNegative));

constexpr auto kPathColumns = std::make_tuple(
    column("kind", &PathRow::kind, "1", "0 normal, 1 lateral.",
           rules::up_to(1, "a kind of path (0 or 1)")),
    column("lateral_depth", &PathRow::lateral_depth, "m",
           "Depth at which a lateral path was run; 0 for a normal path.", rules::kNonNegative),
    column("direction", &PathRow::direction, "1", "Unit direction of the travel of the tool.",
           rules::kUnit),
    column("first_sample", &PathRow::first_sample, "1", "Row of /sample where the path begins.",
           rules::kNonNegative),
    column("sample_count", &PathRow::sample_count, "1", "Number of samples of the path.",
           rules::kNonNegative),
    column("repeats", &PathRow::repeats, "1", "Presses that were averaged; 0 when simulated.",
           rules::kNonNegative, true),
    column("contact_uncertainty", &PathRow::contact_uncertainty, "m",
           "Standard uncertainty of where the displacement begins; NaN when exact.",
           rules::kKnownNonNegative, true));

constexpr auto kSampleColumns = std::make_tuple(
    column("displacement", &CurveSample::displacement, "m", "Of the tool along the path.",
           rules::kNonNegative),
    column("force", &CurveSample::force, "N", "Of the tool on the body.", rules::kFinite),
    column("strain_energy", &CurveSample::strain_energy, "J",
           "Stored in the body, without contact penalty; NaN when measured.", rules::kKnownFinite),
    column("tool_work", &CurveSample::tool_work, "J",
           "Integral of force . d(displacement) since the touch.", rules::kFinite),
    column("min_jacobian", &CurveSample::min_jacobian, "1",
           "Smallest det F over the body; NaN when measured.", rules::kKnownFinite),
    column("penetration", &CurveSample::penetration, "m",
           "Deepest violation of the contact constraint; NaN when measured.", rules::kKnownFinite),
    column("contact_area", &CurveSample::contact_area, "m^2",
           "Reference area in contact; NaN when measured.", rules::kKnownNonNegative),
    column("iterations", &CurveSample::iterations, "1", "Newton iterations of the sample.",
           rules::kNonNegative),
    column("force_scatter", &CurveSample::force_scatter, "N",
           "Standard deviation of the force along the path between repeats; NaN when unknown.",
           rules::kKnownNonNegative, true),
    column("force_uncertainty", &CurveSample::force_uncertainty, "N",
           "Standard uncertainty of the force along the path; NaN when unknown.",
           rules::kKnownNonNegative, true),
    column("contact_energy", &CurveSample::contact_energy, "J",
           "Stored in the springs that enforce the contact; NaN when unknown.", rules::kKnownFinite,
           true),
    column("tension", &CurveSample::tension, "N",
           "Sum of the tensile normal forces of bonded facets; NaN when unknown.",
           rules::kKnownNonNegative, true),
    column("facets_in_contact", &CurveSample::facets_in_contact, "1",
           "Boundary facets that the contact covers, in parts of facets; NaN when unknown.",
           rules::kKnownNonNegative, true),
    column("mesh_difference", &CurveSample::mesh_difference, "N",
           "Force along the path expected from a finer mesh, less this one; NaN when unknown.",
           rules::kKnownFinite, true),
    column("mesh_error", &CurveSample::mesh_error, "N",
           "Bound of the error of the mesh in the force along the path; NaN when unknown.",
           rules::kKnownNonNegative, true),
    column("volume_change", &CurveSample::volume_change, "m^3",
           "Of the body since the touch; NaN when unknown.", rules::kKnownFinite, true));

struct RelaxationTime {
  double time = 0;
};
struct RegionFraction {
  double fraction = 0;
};
struct RegionEnergy {
  double isochoric_energy = 0;
};

constexpr auto kTimeColumns = std::make_tuple(
    column("time", &RelaxationTime::time, "s", "Of each branch, ascending.", rules::kPositive));
constexpr auto kFractionColumns = std::make_tuple(
    column("fraction", &RegionFraction::fraction, "1",
           "Of the instantaneous isochoric stress: all branches of region 0, then of region 1, ...",
           rules::kNonNegative));
constexpr auto kEnergyColumns = std::make_tuple(
    column("isochoric_energy", &RegionEnergy::isochoric_energy, "J",
           "Stored at once in each region: all regions of sample 0, then of sample 1, ...",
           rules::kFinite));

/// The curves as they lie on disk.
struct Flat {
  std::vector<SiteRow> sites;
  std::vector<std::string> reasons;
  std::vector<PathRow> paths;
  std::vector<CurveSample> samples;
};

Flat flatten(const Curves& curves) {
  Flat flat;
  for (const SiteCurves& site : curves.sites) {
    flat.sites.push_back({site.vertex, site.status, site.cpu_seconds,
                          static_cast<std::int64_t>(flat.paths.size()),
                          static_cast<std::int64_t>(site.paths.size())});
    flat.reasons.push_back(site.reason);
    for (const CurvePath& path : site.paths) {
      flat.paths.push_back({path.kind, path.lateral_depth, path.direction,
                            static_cast<std::int64_t>(flat.samples.size()),
                            static_cast<std::int64_t>(path.samples.size()), path.repeats,
                            path.contact_uncertainty});
      flat.samples.insert(flat.samples.end(), path.samples.begin(), path.samples.end());
    }
  }
  return flat;
}

template <class Record>
std::vector<std::int64_t> values_of(const std::vector<Record>& records,
                                    std::int64_t Record::*member) {
  std::vector<std::int64_t> values;
  values.reserve(records.size());
  for (const Record& record : records) values.push_back(record.*member);
  return values;
}

void check_reasons(const Checks& checks, const Flat& flat) {
  for (std::size_t row = 0; row < flat.sites.size(); ++row) {
    const bool complete = flat.sites[row].status == SiteStatus::Complete;
    if (complete == flat.reasons[row].empty()) continue;
    checks.fail_row("/site/reason", row,
                    complete ? "gives a reason, yet the site is complete"
                             : "is empty, yet the site is not complete");
  }
}

void check_order(const Checks& checks, const Flat& flat) {
  for (std::size_t row = 1; row < flat.sites.size(); ++row) {
    if (flat.sites[row].vertex <= flat.sites[row - 1].vertex) {
      checks.fail_row("/site/vertex", row, "is not above the row before it");
    }
  }
  for (const PathRow& path : flat.paths) {
    const auto first = static_cast<std::size_t>(path.first_sample);
    for (std::size_t i = 0; i < static_cast<std::size_t>(path.sample_count); ++i) {
      const double here = flat.samples[first + i].displacement;
      const double before = i == 0 ? 0 : flat.samples[first + i - 1].displacement;
      if (i == 0 && here != 0) {
        checks.fail_row("/sample/displacement", first, "a path does not begin at 0");
      }
      if (here < before) {
        checks.fail_row("/sample/displacement", first + i, "goes backwards along its path");
      }
    }
  }
}

void check_flat(const Checks& checks, const Flat& flat) {
  check_columns(checks, "/site", flat.sites, kSiteColumns);
  check_columns(checks, "/path", flat.paths, kPathColumns);
  check_columns(checks, "/sample", flat.samples, kSampleColumns);
  check_offsets(checks, "/site/first_path", "/site/path_count",
                values_of(flat.sites, &SiteRow::first_path),
                values_of(flat.sites, &SiteRow::path_count), flat.paths.size());
  check_offsets(checks, "/path/first_sample", "/path/sample_count",
                values_of(flat.paths, &PathRow::first_sample),
                values_of(flat.paths, &PathRow::sample_count), flat.samples.size());
  check_reasons(checks, flat);
  check_order(checks, flat);
}

std::vector<RegionEnergy> energies_of(const Flat& flat) {
  std::vector<RegionEnergy> energies;
  for (const CurveSample& sample : flat.samples)
    for (const double energy : sample.isochoric_energy) energies.push_back({energy});
  return energies;
}

void check_energies(const Checks& checks, const Flat& flat, const RegionRelaxation& relaxation) {
  const std::size_t regions = relaxation.empty() ? 0 : relaxation.fractions.size();
  for (std::size_t row = 0; row < flat.samples.size(); ++row)
    if (flat.samples[row].isochoric_energy.size() != regions)
      checks.fail_row("/relaxation/isochoric_energy", row,
                      "has " + std::to_string(flat.samples[row].isochoric_energy.size()) +
                          " regions, and the relaxation " + std::to_string(regions));
}

void write_relaxation(hdf5::Writer& writer, const RegionRelaxation& relaxation, const Flat& flat) {
  if (relaxation.empty()) return;
  std::vector<RelaxationTime> times;
  std::vector<RegionFraction> fractions;
  for (const double time : relaxation.times_s) times.push_back({time});
  for (const std::vector<double>& region : relaxation.fractions)
    for (const double fraction : region) fractions.push_back({fraction});
  writer.group("/relaxation", "Prony series of the regions of the body, and their energies.");
  writer.set_integer("/relaxation", "regions",
                     static_cast<std::int64_t>(relaxation.fractions.size()));
  write_columns(writer, "/relaxation", times, kTimeColumns);
  write_columns(writer, "/relaxation", fractions, kFractionColumns);
  write_columns(writer, "/relaxation", energies_of(flat), kEnergyColumns);
}

/// The series of each region is one that check_relaxation takes.
void check_series(const Checks& checks, const RegionRelaxation& relaxation) {
  for (std::size_t i = 1; i < relaxation.times_s.size(); ++i)
    if (!(relaxation.times_s[i] > relaxation.times_s[i - 1]))
      checks.fail_row("/relaxation/time", i, "is not above the row before it");
  for (std::size_t region = 0; region < relaxation.fractions.size(); ++region) {
    double sum = 0;
    for (const double fraction : relaxation.fractions[region]) sum += fraction;
    if (!(sum < 1))
      checks.fail_row("/relaxation/fraction", region * relaxation.times_s.size(),
                      "begins a region whose fractions do not sum to less than 1");
  }
}

/// Fills the energies of `flat`.
RegionRelaxation read_relaxation(const hdf5::Reader& reader, Flat& flat) {
  RegionRelaxation relaxation;
  if (!reader.has("/relaxation")) return relaxation;
  for (const RelaxationTime& row : read_columns(reader, "/relaxation", kTimeColumns))
    relaxation.times_s.push_back(row.time);
  const std::size_t branches = relaxation.times_s.size();
  const auto fractions = read_columns(reader, "/relaxation", kFractionColumns);
  const std::int64_t regions = reader.integer("/relaxation", "regions");
  if (branches == 0 || regions < 1 || static_cast<std::uint64_t>(regions) > fractions.size() ||
      fractions.size() != static_cast<std::size_t>(regions) * branches)
    reader.fail("/relaxation/fraction", "is not one row for each region and branch");
  const auto count = static_cast<std::size_t>(regions);
  for (std::size_t i = 0; i < fractions.size(); ++i) {
    if (i % branches == 0) relaxation.fractions.emplace_back();
    relaxation.fractions.back().push_back(fractions[i].fraction);
  }
  const auto energies =
      read_columns(reader, "/relaxation", kEnergyColumns, count * flat.samples.size());
  for (std::size_t i = 0; i < energies.size(); ++i)
    flat.samples[i / count].isochoric_energy.push_back(energies[i].isochoric_energy);
  return relaxation;
}

void check_heading(const Checks& checks, const Curves& curves) {
  const auto check = [&](const char* name, double value) {
    if (!(std::isfinite(value) && value >= 0)) checks.fail(name, "is not finite and not negative");
  };
  check("/@tool_radius", curves.tool.radius);
  check("/@tool_edge_radius", curves.tool.edge_radius);
  check("/@tool_length", curves.tool.length);
  check("/@depth", curves.depth);
  check("/@lateral_travel", curves.lateral_travel);
  const double confidence = curves.mesh_error_confidence;
  if (!std::isnan(confidence) && !(confidence >= 0 && confidence <= 1))
    checks.fail("/@mesh_error_confidence", "is not a probability");
  checks.digest("/@body_sha256", curves.body_sha256, true);
  check_provenance(checks, curves.provenance);
}

void unflatten(const Flat& flat, Curves& curves) {
  for (std::size_t s = 0; s < flat.sites.size(); ++s) {
    const SiteRow& row = flat.sites[s];
    SiteCurves site{row.vertex, row.status, flat.reasons[s], row.cpu_seconds, {}};
    for (std::int64_t p = row.first_path; p < row.first_path + row.path_count; ++p) {
      const PathRow& path = flat.paths[static_cast<std::size_t>(p)];
      const auto first = flat.samples.begin() + path.first_sample;
      site.paths.push_back({path.kind,
                            path.lateral_depth,
                            path.direction,
                            {first, first + path.sample_count},
                            path.repeats,
                            path.contact_uncertainty});
    }
    curves.sites.push_back(std::move(site));
  }
}

}  // namespace

double response_force(const CurvePath& path, const CurveSample& sample) {
  const Vec3 start = path.kind == PathKind::Lateral ? path.samples.front().force : Vec3{};
  return dot(sample.force - start, path.direction);
}

void write_curves(const std::filesystem::path& path, const Curves& curves) {
  const Checks checks(path);
  const Flat flat = flatten(curves);
  check_heading(checks, curves);
  check_flat(checks, flat);
  check_series(checks, curves.relaxation);
  check_energies(checks, flat, curves.relaxation);
  hdf5::Writer writer(path);
  write_root(writer, kCurvesArtifact, kCurvesSchema,
             "Raw force-deflection curves, a status per site.");
  writer.set_text("/", "tool_shape", curves.tool.shape);
  writer.set_real("/", "tool_radius", curves.tool.radius);
  writer.set_text("/", "tool_friction", curves.tool.friction);
  writer.set_real("/", "tool_edge_radius", curves.tool.edge_radius);
  writer.set_real("/", "tool_length", curves.tool.length);
  writer.set_real("/", "depth", curves.depth);
  writer.set_real("/", "lateral_travel", curves.lateral_travel);
  writer.set_text("/", "body_sha256", curves.body_sha256);
  if (!std::isnan(curves.mesh_error_confidence))
    writer.set_real("/", "mesh_error_confidence", curves.mesh_error_confidence);
  writer.group("/site", "One row for each vertex of the response surface that was pressed.");
  write_columns(writer, "/site", flat.sites, kSiteColumns);
  writer.texts("/site/reason", flat.reasons, "Why the site is not complete; empty when it is.");
  writer.group("/path", "One row for each path of the tool, site by site.");
  write_columns(writer, "/path", flat.paths, kPathColumns);
  writer.group("/sample", "One row for each converged state of the tool, path by path.");
  write_columns(writer, "/sample", flat.samples, kSampleColumns);
  write_relaxation(writer, curves.relaxation, flat);
  write_provenance(writer, curves.provenance);
  writer.commit();
}

Curves read_curves(const std::filesystem::path& path) {
  hdf5::Reader reader(path, kCurvesRemedy);
  reader.require_artifact(kCurvesArtifact, {kCurvesSchema});
  Curves curves;
  curves.tool.shape = reader.text("/", "tool_shape");
  curves.tool.radius = reader.real("/", "tool_radius");
  curves.tool.friction = reader.text("/", "tool_friction");
  if (reader.has_attribute("/", "tool_edge_radius"))
    curves.tool.edge_radius = reader.real("/", "tool_edge_radius");
  if (reader.has_attribute("/", "tool_length"))
    curves.tool.length = reader.real("/", "tool_length");
  curves.depth = reader.real("/", "depth");
  curves.lateral_travel = reader.real("/", "lateral_travel");
  curves.body_sha256 = reader.text("/", "body_sha256");
  if (reader.has_attribute("/", "mesh_error_confidence"))
    curves.mesh_error_confidence = reader.real("/", "mesh_error_confidence");
  Flat flat;
  flat.sites = read_columns(reader, "/site", kSiteColumns);
  flat.reasons = reader.texts("/site/reason", flat.sites.size());
  flat.paths = read_columns(reader, "/path", kPathColumns);
  flat.samples = read_columns(reader, "/sample", kSampleColumns);
  curves.relaxation = read_relaxation(reader, flat);
  curves.provenance = read_provenance(reader);
  const Checks checks(reader);
  check_heading(checks, curves);
  check_flat(checks, flat);
  check_series(checks, curves.relaxation);
  unflatten(flat, curves);
  return curves;
}

}  // namespace palpate
