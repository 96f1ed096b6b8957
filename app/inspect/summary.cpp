// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/inspect/summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "fitting/response/accuracy.hpp"
#include "fitting/response/mesh_error.hpp"
#include "format/artifact.hpp"
#include "format/body.hpp"
#include "format/curves.hpp"
#include "format/deformation.hpp"
#include "format/flat_file.hpp"
#include "format/guarantee.hpp"
#include "format/library.hpp"
#include "format/recording.hpp"
#include "format/session_journal.hpp"
#include "format/site_fields.hpp"
#include "format/site_journal.hpp"
#include "format/site_record.hpp"
#include "runtime/palpate.h"

namespace palpate::app {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has neither infinity nor NaN: such a value is null, with the reason.
Json with_unit(double value, const char* unit) {
  if (std::isnan(value)) return {{"value", nullptr}, {"unit", unit}, {"why", "unknown"}};
  if (std::isinf(value)) {
    return {{"value", nullptr}, {"unit", unit}, {"why", "no bound"}};
  }
  return {{"value", value}, {"unit", unit}};
}

Json box_of(const std::vector<Vec3>& points) {
  if (points.empty()) return nullptr;
  Vec3 low = points.front(), high = points.front();
  for (const Vec3& p : points) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  return {{"low", low}, {"high", high}, {"unit", "m"}};
}

double volume(const Body& body, std::size_t t) {
  const auto corner = [&](std::size_t i) {
    return body.nodes[static_cast<std::size_t>(body.tetrahedra[t][i])];
  };
  return dot(corner(1) - corner(0), cross(corner(2) - corner(0), corner(3) - corner(0))) / 6;
}

Json regions_of(const Body& body) {
  std::vector<double> volumes(body.region_names.size(), 0);
  std::vector<std::int64_t> counts(body.region_names.size(), 0);
  for (std::size_t t = 0; t < body.tetrahedra.size(); ++t) {
    const auto region = static_cast<std::size_t>(body.tetrahedron_region[t]);
    volumes[region] += volume(body, t);
    ++counts[region];
  }
  Json regions = Json::object();
  for (std::size_t r = 0; r < volumes.size(); ++r) {
    regions[body.region_names[r]] = {{"tetrahedra", counts[r]},
                                     {"volume", with_unit(volumes[r], "m^3")}};
  }
  return regions;
}

Json summary_of(const Body& body) {
  const auto& is_site = body.response.is_site;
  return {{"name", body.name},
          {"nodes", body.nodes.size()},
          {"tetrahedra", body.tetrahedra.size()},
          {"boundary_facets", body.boundary.size()},
          {"fixed_nodes", body.fixed_nodes.size()},
          {"foundation_facets", body.foundation.size()},
          {"response_vertices", body.response.node.size()},
          {"response_triangles", body.response.triangles.size()},
          {"sites", std::count(is_site.begin(), is_site.end(), 1)},
          {"regions", regions_of(body)},
          {"bounding_box", box_of(body.nodes)}};
}

Json failures_of(const Curves& curves) {
  Json failures = Json::array();
  for (const SiteCurves& site : curves.sites) {
    if (site.status == SiteStatus::Complete) continue;
    failures.push_back({{"vertex", site.vertex},
                        {"status", site.status == SiteStatus::Failed ? "failed" : "partial"},
                        {"reason", site.reason}});
  }
  return failures;
}

/// The largest value and its site; unknown values do not count.
struct Largest {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::int32_t vertex = -1;

  void take(double other, std::int32_t at) {
    if (std::isnan(other) || other <= value) return;
    value = other;
    vertex = at;
  }
};

/// Quality of the contact: penetration, penalty energy over strain energy, and the tensile part of
/// a no-slip contact over its force.
Json contact_of(const Curves& curves) {
  Largest penetration, contact_energy, tension;
  for (const SiteCurves& site : curves.sites)
    for (const CurvePath& path : site.paths)
      for (const CurveSample& sample : path.samples) {
        penetration.take(sample.penetration, site.vertex);
        if (sample.strain_energy > 0)
          contact_energy.take(sample.contact_energy / sample.strain_energy, site.vertex);
        if (norm(sample.force) > 0) tension.take(sample.tension / norm(sample.force), site.vertex);
      }
  if (std::max({penetration.vertex, contact_energy.vertex, tension.vertex}) < 0) return "unknown";
  return {{"max_penetration", with_unit(penetration.value, "m")},
          {"site_of_max_penetration", penetration.vertex},
          {"max_contact_energy_over_strain_energy", contact_energy.value},
          {"site_of_max_contact_energy", contact_energy.vertex},
          {"max_tension_over_force", tension.value},
          {"site_of_max_tension", tension.vertex}};
}

/// |work of the tool / stored energy - 1| at the end of a path; NaN where one of them is unknown.
double imbalance_of(const CurvePath& path) {
  if (path.samples.empty()) return std::numeric_limits<double>::quiet_NaN();
  const CurveSample& end = path.samples.back();
  const double stored = end.strain_energy + end.contact_energy;
  return stored > 0 ? std::abs(end.tool_work / stored - 1)
                    : std::numeric_limits<double>::quiet_NaN();
}

/// Balance of work and stored energy: they differ by the residual of the solver and by the
/// integration of the force over the increments.
Json energy_of(const Curves& curves) {
  constexpr double kHalfAPercent = 0.005;
  Largest imbalance;
  int paths = 0, beyond = 0;
  for (const SiteCurves& site : curves.sites)
    for (const CurvePath& path : site.paths) {
      const double here = imbalance_of(path);
      imbalance.take(here, site.vertex);
      paths += std::isnan(here) ? 0 : 1;
      beyond += here > kHalfAPercent ? 1 : 0;
    }
  if (paths == 0) return "unknown";
  return {{"max_imbalance", imbalance.value},
          {"site_of_max_imbalance", imbalance.vertex},
          {"paths_with_balance", paths},
          {"paths_off_by_more_than_half_a_percent", beyond}};
}

/// The bound of the error of the mesh in the forces, relative.
Json mesh_error_of(const Curves& curves) {
  if (std::isnan(curves.mesh_error_confidence)) return "unknown";
  const fitting::MeshErrorSummary error = fitting::mesh_error_summary(curves);
  Json summary = {{"median_at_end_of_press", error.median_at_end},
                  {"max_at_end_of_press", error.worst_at_end},
                  {"median_at_first_sample", error.median_at_first},
                  {"max_at_first_sample", error.worst_at_first}};
  const fitting::MeshErrorSummary lateral = fitting::mesh_error_summary(curves, PathKind::Lateral);
  if (!std::isnan(lateral.median_at_end)) {
    summary["median_at_end_of_lateral_path"] = lateral.median_at_end;
    summary["max_at_end_of_lateral_path"] = lateral.worst_at_end;
  }
  summary["confidence"] = curves.mesh_error_confidence;
  return summary;
}

Json summary_of(const Curves& curves) {
  double cpu = 0, force = 0;
  double jacobian = std::numeric_limits<double>::quiet_NaN();  // unknown for measured curves
  std::size_t samples = 0;
  for (const SiteCurves& site : curves.sites) {
    cpu += site.cpu_seconds;
    for (const CurvePath& path : site.paths) {
      samples += path.samples.size();
      for (const CurveSample& sample : path.samples) {
        force = std::max(force, norm(sample.force));
        jacobian = std::fmin(jacobian, sample.min_jacobian);
      }
    }
  }
  const Json failures = failures_of(curves);
  return {{"tool", curves.tool.shape},
          {"tool_radius", with_unit(curves.tool.radius, "m")},
          {"friction_of_normal_path", curves.tool.friction},
          {"depth", with_unit(curves.depth, "m")},
          {"lateral_travel", with_unit(curves.lateral_travel, "m")},
          {"sites", curves.sites.size()},
          {"sites_not_complete", failures.size()},
          {"samples", samples},
          {"max_force", with_unit(force, "N")},
          {"min_jacobian", std::isnan(jacobian) ? Json("unknown") : Json(jacobian)},
          {"contact", contact_of(curves)},
          {"energy", energy_of(curves)},
          {"mesh_error", mesh_error_of(curves)},
          {"cpu_time", with_unit(cpu, "s")},
          {"content_sha256", content_sha256(curves)},
          {"failures", failures}};
}

Json summary_of(const Certificate& certificate) {
  if (certificate.triangles.empty()) return "not yet certified: run `palpate certify`";
  Json devices = Json::array();
  for (const DeviceCertificate& d : certificate.devices) {
    devices.push_back({{"device", d.device},
                       {"verdict", verdict(certificate, d)},
                       {"damping", with_unit(d.damping, "N s/m")},
                       {"lowest_certified_rate", with_unit(d.lowest_rate, "Hz")},
                       {"linear_limit_at_1_kHz", with_unit(d.linear_limit, "N/m")},
                       {"no_delay_limit_at_1_kHz", with_unit(d.no_delay_limit, "N/m")},
                       {"coulomb_friction", with_unit(d.coulomb_friction, "N")},
                       {"delay", with_unit(d.delay, "s")},
                       {"position_resolution", with_unit(d.position_resolution, "m")},
                       {"force_resolution", with_unit(d.force_resolution, "N")},
                       {"largest_position_step", with_unit(d.largest_position_step, "m")},
                       {"rate_of_mahvash_hayward_2005", with_unit(d.published_rate, "Hz")}});
  }
  const auto passive = std::count_if(certificate.triangles.begin(), certificate.triangles.end(),
                                     [](const auto& t) { return t.sliding_passive; });
  return {{"friction", certificate.friction},
          {"depth", with_unit(certificate.depth, "m")},
          {"L_stick", with_unit(certificate.stick, "N/m")},
          {"L_slip", with_unit(certificate.slip, "N/m")},
          {"L_min", with_unit(certificate.min_lipschitz_bound, "N/m")},
          {"enforced_bound", with_unit(enforced_lipschitz_bound(certificate), "N/m")},
          {"relaxation_rate", with_unit(certificate.relaxation_rate, "1/s")},
          {"worst_triangle", certificate.worst_triangle},
          {"limited_by", certificate.limited_by},
          {"basis", certificate.basis},
          {"triangles_with_passive_sliding", passive},
          {"devices", devices}};
}

/// The relaxation of the responses: smallest, median and largest fraction at each time.
Json relaxation_of(const Library& library) {
  Json times = Json::array();
  for (std::size_t i = 0; i < library.relaxation_times.size(); ++i) {
    std::vector<double> fractions;
    for (const NodeResponse& node : library.responses)
      if (i < node.relaxation.size()) fractions.push_back(static_cast<double>(node.relaxation[i]));
    std::sort(fractions.begin(), fractions.end());
    if (fractions.empty()) continue;
    times.push_back({{"time", with_unit(library.relaxation_times[i], "s")},
                     {"min_fraction", fractions.front()},
                     {"median_fraction", fractions[fractions.size() / 2]},
                     {"max_fraction", fractions.back()}});
  }
  return times;
}

/// How far presses lean: median and largest length of the lean of a vertex with a response, at the
/// depth where it is longest.
Json lean_of(const Library& library) {
  std::vector<double> lengths;
  for (const NodeResponse& node : library.responses) {
    if (node.status == ResponseStatus::Hole) continue;
    const double length = norm(vec3_of(node.lean));
    const bool grows = library.kind == ResponseKind::Coupled && length > 0;
    lengths.push_back(grows ? node.coupling.largest() * length : length);
  }
  std::sort(lengths.begin(), lengths.end());
  return {{"median", lengths[lengths.size() / 2]}, {"max", lengths.back()}};
}

/// How much stiffer drags are across the soft axes than along them: median and largest quotient of
/// the stiffnesses of a vertex with a response.
Json softness_of(const Library& library) {
  std::vector<double> quotients;
  for (const NodeResponse& node : library.responses) {
    if (node.status == ResponseStatus::Hole) continue;
    const Vec3 b = vec3_of(node.soft_axis);
    const double along = 1 - dot(b, b);
    quotients.push_back(1 / (along * along));
  }
  std::sort(quotients.begin(), quotients.end());
  return {{"median", quotients[quotients.size() / 2]}, {"max", quotients.back()}};
}

/// What is guaranteed on each device.
Json rates_of(const Certificate& certificate) {
  if (certificate.devices.empty()) return "none is guaranteed: no device profile was given";
  Json rates = Json::object();
  for (const DeviceCertificate& d : certificate.devices) rates[d.device] = verdict(certificate, d);
  return rates;
}

Json summary_of(const Library& library) {
  std::size_t fitted = 0, interpolated = 0, holes = 0, knots = 0;
  double normal_error = 0, lateral_error = 0, mesh_error = kUnknown, lateral_mesh_error = kUnknown;
  for (const NodeResponse& response : library.responses) {
    fitted += response.status == ResponseStatus::Fitted ? 1 : 0;
    interpolated += response.status == ResponseStatus::Interpolated ? 1 : 0;
    holes += response.status == ResponseStatus::Hole ? 1 : 0;
    knots += response.normal.knot.size() + response.lateral.knot.size();
    normal_error = std::max(normal_error, response.normal_error);
    lateral_error = std::max(lateral_error, response.lateral_error);
    mesh_error = std::fmax(mesh_error, response.normal_mesh_error);
    lateral_mesh_error = std::fmax(lateral_mesh_error, response.lateral_mesh_error);
  }
  Json summary = {{"name", library.name},
                  {"guarantee", guarantee_text(library.certificate)},
                  {"rates", rates_of(library.certificate)},
                  {"accuracy", fitting::accuracy_text(library)},
                  {"tool", library.tool_shape},
                  {"tool_radius", with_unit(library.tool_radius, "m")},
                  {"vertices", library.positions.size()},
                  {"triangles", library.triangles.size()},
                  {"responses_fitted", fitted},
                  {"responses_interpolated", interpolated},
                  {"holes", holes},
                  {"knots", knots},
                  {"max_normal_error", with_unit(normal_error, "N")},
                  {"max_lateral_error", with_unit(lateral_error, "N")},
                  {"max_normal_mesh_error", with_unit(mesh_error, "N")},
                  {"max_lateral_mesh_error", with_unit(lateral_mesh_error, "N")},
                  {"bounding_box", box_of(library.positions)}};
  if (library.leans()) summary["lean"] = lean_of(library);
  if (library.has_soft_axes()) summary["stiffness_across_over_along"] = softness_of(library);
  if (library.relaxes()) summary["relaxation"] = relaxation_of(library);
  summary["certificate"] = summary_of(library.certificate);
  return summary;
}

Json summary_of(RecordingReader& reader) {
  double depth = 0, force = 0;
  std::int64_t slowest = 0, contact = 0, beyond = 0;
  RecordedStep last;
  for (auto steps = reader.next(); !steps.empty(); steps = reader.next()) {
    for (const RecordedStep& step : steps) {
      depth = std::max(depth, step.depth);
      force = std::max(force, norm(step.force));
      slowest = std::max(slowest, step.latency_ns);
      contact += (step.status & PALPATE_CONTACT) != 0 ? 1 : 0;
      beyond += (step.status & PALPATE_BEYOND_DEPTH) != 0 ? 1 : 0;
    }
    last = steps.back();
  }
  const RecordingHeading& recording = reader.heading();
  return {{"device", recording.device},
          {"library_sha256", recording.library_sha256},
          {"rate", with_unit(recording.rate, "Hz")},
          {"friction", recording.friction},
          {"steps", reader.steps()},
          {"steps_in_contact", contact},
          {"steps_extrapolated_beyond_depth", beyond},
          {"duration", with_unit(static_cast<double>(last.time_ns) * 1e-9, "s")},
          {"max_depth", with_unit(depth, "m")},
          {"max_force", with_unit(force, "N")},
          {"absorbed_energy", with_unit(last.absorbed, "J")},
          {"longest_force_step", with_unit(static_cast<double>(slowest) * 1e-9, "s")}};
}

Json provenance_of(const Provenance& provenance) {
  Json steps = Json::array();
  for (const ProvenanceStep& step : provenance.steps) {
    Json inputs = Json::object(), facts = Json::object();
    for (const InputDigest& input : step.inputs) inputs[input.name] = input.sha256;
    for (const auto& [name, value] : step.facts) facts[name] = value;
    steps.push_back({{"stage", step.stage},
                     {"version", step.version},
                     {"git_revision", step.git_revision},
                     {"utc", step.utc},
                     {"inputs", inputs},
                     {"facts", facts},
                     {"resolved_case", step.resolved_case}});
  }
  return steps;
}

template <class Artifact>
Json complete(Json head, const Artifact& artifact) {
  head.update(summary_of(artifact));
  head["provenance"] = provenance_of(artifact.provenance);
  return head;
}

/// A running or interrupted campaign.
Json summary_of(const JournalContents& journal) {
  std::int64_t not_complete = 0;
  double cpu = 0;
  for (const SiteCurves& site : journal.sites) {
    not_complete += site.status == SiteStatus::Complete ? 0 : 1;
    cpu += site.cpu_seconds;
  }
  return {{"sites_planned", journal.heading.planned_sites},
          {"sites_done", journal.sites.size()},
          {"sites_not_complete", not_complete},
          {"cpu_time", with_unit(cpu, "s")},
          {"incomplete_bytes_at_end", journal.broken_bytes},
          {"key", journal.heading.key}};
}

/// A running or interrupted session.
Json summary_of(const SessionSummary& session) {
  Json gaps = Json::array();
  for (const JournalGap& gap : session.gaps) gaps.push_back(gap_text(gap));
  return {{"device", session.heading.device},
          {"library_sha256", session.heading.library_sha256},
          {"rate", with_unit(session.heading.rate, "Hz")},
          {"steps", session.steps},
          {"duration", with_unit(static_cast<double>(session.last_time_ns) * 1e-9, "s")},
          {"incomplete_bytes_at_end", session.incomplete_bytes},
          {"gaps", gaps}};
}

Json lengths(const std::vector<double>& values) {
  return {{"values", values}, {"unit", "m"}};
}

Json summary_of(const SiteFields& fields) {
  std::vector<double> depths, lateral_depths;
  for (const NormalField& field : fields.normal) depths.push_back(field.depth);
  for (const LateralField& field : fields.lateral) lateral_depths.push_back(field.depth);
  return {{"response_vertex", fields.vertex},
          {"skin_vertices", fields.normal.empty() ? 0 : fields.normal.front().skin.size() / 3},
          {"depths", lengths(depths)},
          {"depths_of_drags", lengths(lateral_depths)}};
}

Json summary_of(const Deformation& skin) {
  return {{"tool", skin.tool_shape},
          {"tool_radius", with_unit(skin.tool_radius, "m")},
          {"skin_vertices", skin.positions.size()},
          {"skin_triangles", skin.triangles.size()},
          {"vertices_of_the_library", skin.vertex_of.size()},
          {"sites", skin.sites.size()},
          {"depths", lengths(skin.depths)},
          {"lateral_depths", lengths(skin.lateral_depths)},
          {"drags_differ_between_directions", !skin.anisotropic.empty()},
          {"modes", skin.mode_count()},
          {"rms_displacement_that_no_mode_has", with_unit(skin.rms_left_out, "m")},
          {"reach_of_the_local_part", with_unit(skin.reach, "m")},
          {"surface_sha256", skin.surface},
          {"bounding_box", box_of(skin.positions)}};
}

bool is_quantity(const Json& value) {
  return value.is_object() && value.contains("value") && value.contains("unit");
}

std::string number_text(const Json& number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", number.get<double>());
  return text;
}

std::string scalar_text(const Json& value) {
  if (is_quantity(value)) {
    if (value["value"].is_null()) return value["why"].get<std::string>();
    return number_text(value["value"]) + " " + value["unit"].get<std::string>();
  }
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return number_text(value);
  if (value.is_array()) {
    std::string list;
    for (const Json& item : value) list += (list.empty() ? "" : ", ") + scalar_text(item);
    return list.empty() ? "none" : list;
  }
  return value.dump();
}

bool holds_objects(const Json& value) {
  return value.is_array() && !value.empty() && value.front().is_object();
}

void multiply(Json& value, double factor) {
  if (value.is_number()) value = factor * value.get<double>();
  if (value.is_array())
    for (Json& item : value) multiply(item, factor);
}

/// Lengths in mm and volumes in cm^3, as people read them.
Json in_usual_units(Json value) {
  if (!value.is_structured()) return value;
  const std::string unit = value.is_object() && value.contains("unit") && value["unit"].is_string()
                               ? value["unit"].get<std::string>()
                               : std::string();
  const bool is_length = unit == "m", is_volume = unit == "m^3";
  for (auto& [name, item] : value.items()) {
    if (is_length || is_volume) multiply(item, is_length ? 1e3 : 1e6);
    item = in_usual_units(std::move(item));
  }
  if (is_length) value["unit"] = "mm";
  if (is_volume) value["unit"] = "cm^3";
  return value;
}

/// `files`: the names are those of files, and stay as they are.
void print(const Json& object, const std::string& indent, std::string& out, bool files = false) {
  for (const auto& [name, value] : object.items()) {
    std::string label = name;
    if (!files) std::replace(label.begin(), label.end(), '_', ' ');
    const bool is_tree = value.is_object() && !is_quantity(value);
    if (!is_tree && !holds_objects(value)) {
      const std::string text = scalar_text(value);
      if (text.find('\n') != std::string::npos) continue;  // a resolved case: see --json
      out.append(indent).append(label).append(": ").append(text).append("\n");
      continue;
    }
    out.append(indent).append(label).append(":").append(value.empty() ? " none\n" : "\n");
    if (is_tree) {
      print(value, indent + "  ", out, name == "inputs");
      continue;
    }
    for (const Json& item : value) {
      out.append(indent).append("  -\n");
      print(item, indent + "    ", out);
    }
  }
}

}  // namespace

Json summarize_artifact(const std::filesystem::path& file) {
  if (file.extension() == ".journal" && is_session_journal(file)) {
    Json summary{{"file", file.string()}, {"artifact", "palpate.session"}};
    const SessionSummary session = summarize_session(file);
    summary.update(summary_of(session));
    summary["provenance"] = provenance_of(session.heading.provenance);
    return summary;
  }
  if (file.extension() == ".journal") {
    Json summary{{"file", file.string()}, {"artifact", "palpate.journal"}};
    summary.update(summary_of(read_site_journal(file)));
    return summary;
  }
  if (file.extension() == ".pdef") {
    Json summary{{"file", file.string()}, {"artifact", "palpate.deformation"}};
    summary.update(summary_of(read_deformation(file)));
    return summary;
  }
  if (file.extension() == ".fields") {
    Json summary{{"file", file.string()}, {"artifact", "palpate.fields"}};
    summary.update(summary_of(read_site_fields(file)));
    return summary;
  }
  const std::string remedy = "give an artifact of palpate", kind = artifact_kind(file, remedy);
  const Json head{{"file", file.string()},
                  {"artifact", kind},
                  {is_flat_file(file) ? "version" : "schema", schema_of_file(file, remedy)}};
  if (kind == "palpate.body") return complete(head, read_body(file));
  if (kind == "palpate.curves") return complete(head, read_curves(file));
  if (kind == "palpate.library") return complete(head, read_library(file));
  if (kind == "palpate.recording") {
    RecordingReader reader(file);
    Json summary = head;
    summary.update(summary_of(reader));
    summary["provenance"] = provenance_of(reader.heading().provenance);
    return summary;
  }
  throw Error(ErrorKind::Configuration, file.string(), "unknown kind of artifact '" + kind + "'",
              "use the version of palpate that made it");
}

std::string summary_text(const Json& summary) {
  std::string out;
  print(in_usual_units(summary), "", out);
  return out;
}

}  // namespace palpate::app
