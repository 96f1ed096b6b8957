// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/page_data.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include "app/report/embed.hpp"
#include "app/report/figures.hpp"
#include "app/report/inclusions.hpp"
#include "app/report/repair_file.hpp"
#include "app/report/straight_press.hpp"
#include "app/report/surface_map.hpp"
#include "app/report/touch.hpp"
#include "fitting/response/accuracy.hpp"
#include "fitting/response/fit_errors.hpp"
#include "fitting/response/leaning_response.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/quality.hpp"

namespace palpate::report {

namespace {

using nlohmann::json;

void append(std::vector<float>& out, const Vec3& v) {
  for (const double x : v) out.push_back(static_cast<float>(x));
}

std::vector<std::int32_t> flat(const std::vector<Triangle>& triangles) {
  std::vector<std::int32_t> out;
  for (const Triangle& t : triangles) out.insert(out.end(), t.begin(), t.end());
  return out;
}

void require(bool fits, const char* problem) {
  if (fits) return;
  throw Error(ErrorKind::Configuration, "report", problem,
              "give body, curves and library of the same pipeline run");
}

void check_together(const ReportInput& input) {
  require(input.body != nullptr && input.curves != nullptr && input.library != nullptr,
          "body, curves or library missing");
  const Body& body = *input.body;
  const Library& library = *input.library;
  const std::size_t vertices = body.response.node.size();
  require(library.responses.size() == vertices && library.positions.size() == vertices,
          "the numbers of vertices of the library and of the response surface differ");
  require(body.response.inward.size() == vertices && body.response.is_site.size() == vertices,
          "the response surface of the body is incomplete");
  for (const SiteCurves& site : input.curves->sites)
    require(site.vertex >= 0 && to_index(site.vertex) < vertices,
            "a vertex of the curves is not in the body");
  const auto& certificates = library.certificate.triangles;
  require(certificates.empty() || certificates.size() == library.triangles.size(),
          "the numbers of triangles of the certificate and of the library differ");
}

/// Facet kinds of the picture.
enum FacetKind : std::uint8_t { Touchable = 0, NoResponse = 1, Fixed = 2 };

std::vector<std::uint8_t> facet_kinds(const Body& body, const Library& library,
                                      const SurfaceMap& map,
                                      const std::vector<std::int32_t>& in_library) {
  std::vector<std::uint8_t> fixed(body.nodes.size(), 0);
  for (const std::int32_t n : body.fixed_nodes) fixed.at(to_index(n)) = 1;
  std::vector<std::uint8_t> kinds;
  for (std::size_t f = 0; f < map.facets.size(); ++f) {
    const std::int32_t m = map.facet_triangle[f];
    bool touchable = m >= 0 && in_library[to_index(m)] >= 0;
    if (touchable) {
      for (const std::int32_t v : body.response.triangles[to_index(m)])
        touchable = touchable && library.responses[to_index(v)].status != ResponseStatus::Hole;
    }
    const auto is_fixed = [&](std::int32_t p) {
      return fixed[to_index(map.node[to_index(p)])] != 0;
    };
    const bool all_fixed = std::all_of(map.facets[f].begin(), map.facets[f].end(), is_fixed);
    kinds.push_back(touchable ? Touchable : all_fixed ? Fixed : NoResponse);
  }
  return kinds;
}

/// 1 for each facet on springs.
std::vector<std::uint8_t> sprung_facets(const Body& body) {
  std::vector<std::uint8_t> sprung(body.boundary.size(), 0);
  for (const SprungFacet& spring : body.foundation) sprung.at(to_index(spring.facet)) = 1;
  return sprung;
}

constexpr std::uint8_t kNotRun = 255;

json vertex_data(const ReportInput& input, const std::vector<PeakForce>& peaks) {
  const Library& library = *input.library;
  const std::size_t size = library.responses.size();
  std::vector<float> position, inward, normal_error, lateral_error, mesh_error;
  std::vector<std::uint8_t> response_status, site_status(size, kNotRun);
  std::vector<float> cpu(size, 0);
  json reasons = json::object();
  for (const SiteCurves& site : input.curves->sites) {
    site_status[to_index(site.vertex)] = static_cast<std::uint8_t>(site.status);
    cpu[to_index(site.vertex)] = static_cast<float>(site.cpu_seconds);
    if (!site.reason.empty()) reasons[std::to_string(site.vertex)] = site.reason;
  }
  for (std::size_t v = 0; v < size; ++v) {
    const NodeResponse& response = library.responses[v];
    append(position, library.positions[v]);
    append(inward, library.inward[v]);
    response_status.push_back(static_cast<std::uint8_t>(response.status));
    const bool fitted = response.status == ResponseStatus::Fitted;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    normal_error.push_back(static_cast<float>(fitted ? response.normal_error : nan));
    lateral_error.push_back(static_cast<float>(fitted ? response.lateral_error : nan));
    mesh_error.push_back(static_cast<float>(response.normal_mesh_error));
  }
  std::vector<float> misfit(size, std::numeric_limits<float>::quiet_NaN());
  for (const fitting::SiteFitError& error : fitting::fit_errors(library, *input.curves))
    misfit[to_index(error.vertex)] = static_cast<float>(std::max(error.normal, error.lateral));
  std::vector<float> normal_peak, lateral_peak;
  for (const PeakForce& peak : peaks) {
    normal_peak.push_back(static_cast<float>(peak.normal));
    lateral_peak.push_back(static_cast<float>(peak.lateral));
  }
  return {{"position", column(position)},
          {"inward", column(inward)},
          {"is_site", column(input.body->response.is_site)},
          {"response_status", column(response_status)},
          {"site_status", column(site_status)},
          {"cpu_seconds", column(cpu)},
          {"reasons", reasons},
          {"normal_error", column(normal_error)},
          {"lateral_error", column(lateral_error)},
          {"mesh_error", column(mesh_error)},
          {"misfit", column(misfit)},
          {"visible_misfit", fitting::kVisibleFitError},
          {"normal_peak", column(normal_peak)},
          {"lateral_peak", column(lateral_peak)}};
}

/// Where the samples of a path come from.
enum PathOrigin : std::uint8_t { Computed = 0, Measured = 1, Assumed = 2 };

/// A lateral path that nobody repeated, of a site that was measured, is made of its normal path.
PathOrigin origin_of(const SiteCurves& site, const CurvePath& path) {
  if (path.repeats > 0) return Measured;
  const bool site_is_measured =
      std::ranges::any_of(site.paths, [](const CurvePath& other) { return other.repeats > 0; });
  return site_is_measured && path.kind == PathKind::Lateral ? Assumed : Computed;
}

/// What is known about the forces of measured paths; null where none is measured.
json measurement_data(const Curves& curves) {
  std::vector<std::uint8_t> origin;
  std::vector<std::int32_t> repeats;
  std::vector<float> uncertainty, scatter;
  for (const SiteCurves& site : curves.sites) {
    for (const CurvePath& path : site.paths) {
      origin.push_back(origin_of(site, path));
      repeats.push_back(path.repeats);
      for (const CurveSample& sample : path.samples) {
        uncertainty.push_back(static_cast<float>(sample.force_uncertainty));
        scatter.push_back(static_cast<float>(sample.force_scatter));
      }
    }
  }
  if (std::ranges::all_of(origin, [](std::uint8_t of) { return of == Computed; })) return {};
  return {{"origin", column(origin)},
          {"repeats", column(repeats)},
          {"uncertainty", column(uncertainty)},
          {"scatter", column(scatter)}};
}

/// What is felt along a drag more than at its start, N: NaN of other paths and without a response.
float rendered_drag(const Library& library, const CurvePath& path, const NodeResponse& node,
                    double displacement) {
  if (path.kind != PathKind::Lateral || node.status == ResponseStatus::Hole)
    return std::numeric_limits<float>::quiet_NaN();
  const fitting::LeaningResponse rendered(node, library.kind);
  return static_cast<float>(rendered.drag_force(path.lateral_depth, displacement, path.direction));
}

}  // namespace

json sample_data(const Curves& curves, const Library& library) {
  std::vector<std::int32_t> vertex;
  std::vector<std::uint8_t> kind;
  std::vector<std::uint32_t> offset{0};
  std::vector<float> lateral_depth, displacement, force, rendered, volume_change;
  for (const SiteCurves& site : curves.sites) {
    for (const CurvePath& path : site.paths) {
      vertex.push_back(site.vertex);
      kind.push_back(static_cast<std::uint8_t>(path.kind));
      lateral_depth.push_back(static_cast<float>(path.lateral_depth));
      const NodeResponse& node = library.responses[to_index(site.vertex)];
      for (const CurveSample& sample : path.samples) {
        displacement.push_back(static_cast<float>(sample.displacement));
        force.push_back(static_cast<float>(
            path.kind == PathKind::Normal ? dot(sample.force, library.inward[to_index(site.vertex)])
                                          : response_force(path, sample)));
        rendered.push_back(rendered_drag(library, path, node, sample.displacement));
        volume_change.push_back(static_cast<float>(sample.volume_change));
      }
      offset.push_back(static_cast<std::uint32_t>(displacement.size()));
    }
  }
  return {{"vertex", column(vertex)},
          {"kind", column(kind)},
          {"lateral_depth", column(lateral_depth)},
          {"offset", column(offset)},
          {"displacement", column(displacement)},
          {"force", column(force)},
          {"rendered", column(rendered)},
          {"coupled", library.kind == ResponseKind::Coupled},
          {"volume_change", column(volume_change)},
          {"measurement", measurement_data(curves)}};
}

namespace {

json balance_data(const Curves& curves) {
  std::vector<float> difference;
  std::vector<std::uint8_t> kind;
  const std::vector<PathBalance> balances = path_balances(curves);
  const PathBalance* worst = nullptr;
  for (const PathBalance& balance : balances) {
    difference.push_back(static_cast<float>(balance.difference));
    kind.push_back(static_cast<std::uint8_t>(balance.kind));
    if (worst == nullptr || std::abs(balance.difference) > std::abs(worst->difference))
      worst = &balance;
  }
  json result = {{"difference", column(difference)}, {"kind", column(kind)}, {"worst", nullptr}};
  if (worst != nullptr) {
    result["worst"] = {{"vertex", worst->vertex},
                       {"kind", static_cast<int>(worst->kind)},
                       {"work", worst->work},
                       {"energy", worst->energy},
                       {"difference", worst->difference}};
  }
  return result;
}

json key_figures(const ReportInput& input) {
  const CampaignFigures figures = campaign_figures(*input.curves);
  const Curves& curves = *input.curves;
  return {{"complete", figures.complete},
          {"partial", figures.partial},
          {"failed", figures.failed},
          {"deepest", figures.deepest},
          {"max_force", figures.max_force},
          {"volume_change", figures.volume_change},
          {"min_jacobian", figures.min_jacobian},
          {"cpu_seconds", figures.cpu_seconds},
          {"mesh_error_confidence", input.curves->mesh_error_confidence},
          {"accuracy", fitting::accuracy_text(*input.library)},
          {"library_bytes", input.library_bytes},
          {"library_vertices", input.library->positions.size()},
          {"library_triangles", input.library->triangles.size()},
          {"depth", curves.depth},
          {"lateral_travel", curves.lateral_travel},
          {"tool_shape", curves.tool.shape},
          {"tool_radius", curves.tool.radius},
          {"tool_edge_radius", curves.tool.edge_radius},
          {"tool_length", curves.tool.length},
          {"tool_friction", curves.tool.friction}};
}

json quality_data(const Body& body) {
  const mesher::Quality quality = mesher::measure_quality(body.nodes, body.tetrahedra);
  return {{"smallest_dihedral", quality.smallest_dihedral},
          {"largest_dihedral", quality.largest_dihedral},
          {"largest_edge_ratio", quality.largest_edge_ratio},
          {"longest_edge", quality.longest_edge},
          {"volume", quality.volume}};
}

}  // namespace

std::vector<std::int32_t> library_triangles(const std::vector<Triangle>& triangles,
                                            const Library& library) {
  const auto key = [](Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
  };
  std::map<Triangle, std::int32_t> index;
  for (std::size_t m = 0; m < library.triangles.size(); ++m)
    index[key(library.triangles[m])] = static_cast<std::int32_t>(m);
  std::vector<std::int32_t> result;
  for (const Triangle& t : triangles) {
    const auto found = index.find(key(t));
    result.push_back(found == index.end() ? -1 : found->second);
  }
  return result;
}

json surface_data(const Body& body, const Library& library, const SurfaceMap& map) {
  const std::vector<std::int32_t> in_library = library_triangles(body.response.triangles, library);
  std::vector<float> points;
  std::vector<double> natural;  // the first two of each point; they sum to 1
  for (const std::int32_t n : map.node) append(points, body.nodes[to_index(n)]);
  for (const Vec3& n : map.natural) natural.insert(natural.end(), {n[0], n[1]});
  return {{"points", column(points)},
          {"facets", index_column(flat(map.facets))},
          {"facet_triangle", index_column(map.facet_triangle)},
          {"facet_kind", column(facet_kinds(body, library, map, in_library))},
          {"facet_sprung", column(sprung_facets(body))},
          {"point_triangle", index_column(map.triangle)},
          {"point_natural", fraction_column(natural)},
          {"triangles", index_column(flat(body.response.triangles))},
          {"library_triangle", column(in_library)}};
}

json response_columns(const Library& library, bool normal) {
  std::vector<std::uint32_t> offset{0};
  std::vector<float> knot, slope;
  for (const NodeResponse& response : library.responses) {
    if (response.status != ResponseStatus::Hole) {
      const ResponseCurve curve =
          normal ? straight_press(response, library.kind) : response.lateral;
      knot.insert(knot.end(), curve.knot.begin(), curve.knot.end());
      slope.insert(slope.end(), curve.slope.begin(), curve.slope.end());
    }
    offset.push_back(static_cast<std::uint32_t>(knot.size()));
  }
  return {{"offset", column(offset)}, {"knot", column(knot)}, {"slope", column(slope)}};
}

json body_data(const Body& body) {
  std::vector<std::int64_t> count(body.region_names.size(), 0);
  for (const std::int32_t region : body.tetrahedron_region) ++count.at(to_index(region));
  json regions = json::array();
  for (std::size_t r = 0; r < count.size(); ++r)
    regions.push_back({{"name", body.region_names[r]}, {"tetrahedra", count[r]}});
  std::vector<Vec3> vertices;
  for (const std::int32_t n : body.response.node) vertices.push_back(body.nodes[to_index(n)]);
  return {{"name", body.name},
          {"nodes", body.nodes.size()},
          {"tetrahedra", body.tetrahedra.size()},
          {"facets", body.boundary.size()},
          {"fixed_nodes", body.fixed_nodes.size()},
          {"sprung_facets", body.foundation.size()},
          {"quality", quality_data(body)},
          {"vertices", body.response.node.size()},
          {"triangles", body.response.triangles.size()},
          {"sites", std::count(body.response.is_site.begin(), body.response.is_site.end(), 1)},
          {"facet_edge", median_edge(body.nodes, body.boundary)},
          {"patch_edge", median_edge(vertices, body.response.triangles)},
          {"regions", regions}};
}

json inclusion_data(const Body& body) {
  json list = json::array();
  for (const Inclusion& inclusion : inclusions(body)) {
    std::vector<float> points;
    for (const std::int32_t n : inclusion.node) append(points, body.nodes[to_index(n)]);
    list.push_back({{"region", body.region_names[to_index(inclusion.region)]},
                    {"points", column(points)},
                    {"facets", index_column(flat(inclusion.facets))}});
  }
  return list;
}

json page_data(const ReportInput& input) {
  check_together(input);
  const Library& library = *input.library;
  std::vector<PeakForce> peaks(library.responses.size());
  for (const SiteCurves& site : input.curves->sites)
    peaks[to_index(site.vertex)] = peak_force(site, library.inward[to_index(site.vertex)]);
  const ChosenVertices chosen = choose_vertices(library, peaks, input.curves->depth);
  const SurfaceMap map = map_boundary(*input.body);
  return {{"title", input.title.empty() ? library.name : input.title},
          {"body", body_data(*input.body)},
          {"key", key_figures(input)},
          {"surface", surface_data(*input.body, library, map)},
          {"inclusions", inclusion_data(*input.body)},
          {"vertices", vertex_data(input, peaks)},
          {"normal", response_columns(library, true)},
          {"lateral", response_columns(library, false)},
          {"samples", sample_data(*input.curves, library)},
          {"chosen",
           {{"softest", chosen.softest},
            {"median", chosen.median},
            {"stiffest", chosen.stiffest},
            {"worst_fit", chosen.worst_fit}}},
          {"balance", balance_data(*input.curves)},
          {"certificate", certificate_data(library)},
          {"comparison", comparison_data(input.comparison, library.responses.size())},
          {"calibration", calibration_data(input.calibration)},
          {"fidelity", fidelity_data(input.fidelity, input.library_sha256)},
          {"repair", repair_data(input.repair, input.body->provenance)},
          {"session", input.session == nullptr ? json() : session_data(*input.session)},
          {"touch", touch_data(*input.body, library, input.deformation, map.node)},
          {"relaxation", relaxation_data(library, chosen.median)},
          {"provenance", provenance_data(input)}};
}

}  // namespace palpate::report
