// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/fit.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "fitting/response/between_nodes.hpp"
#include "fitting/response/couple.hpp"
#include "fitting/response/curve_fit.hpp"
#include "fitting/response/fill.hpp"
#include "fitting/response/interpolate.hpp"
#include "fitting/response/lean.hpp"
#include "fitting/response/relaxation_fraction.hpp"
#include "fitting/response/response_surface.hpp"
#include "fitting/response/site_samples.hpp"
#include "fitting/response/soft_axis.hpp"
#include "format/error.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {
namespace {

std::string site_name(std::int32_t vertex) {
  return "site at vertex " + std::to_string(vertex);
}

void check_site(const Body& body, const SiteCurves& site) {
  const std::string where = site_name(site.vertex);
  const std::string remedy = "fit the curves with the body they were computed on";
  const auto count = static_cast<std::int64_t>(body.response.node.size());
  if (site.vertex < 0 || site.vertex >= count) {
    refuse(where, "the body has only " + std::to_string(count) + " response vertices", remedy);
  }
  const auto vertex = static_cast<std::size_t>(site.vertex);
  if (body.response.is_site[vertex] == 0) refuse(where, "the vertex is fixed by a support", remedy);
  for (const CurvePath& path : site.paths) {
    if (path.kind == PathKind::Normal &&
        norm(path.direction - body.response.inward[vertex]) > 1e-3) {
      refuse(where, "the normal path does not run along the press direction of the vertex", remedy);
    }
  }
}

void check_curves(const Body& body, const Curves& curves) {
  std::vector<char> seen(body.response.node.size(), 0);
  for (const SiteCurves& site : curves.sites) {
    check_site(body, site);
    char& mark = seen[static_cast<std::size_t>(site.vertex)];
    if (mark != 0) {
      refuse(site_name(site.vertex), "it appears twice in the curves", "merge the shards once");
    }
    mark = 1;
  }
}

void check_relaxation_times(const Curves& curves) {
  const std::size_t times = curves.relaxation.times_s.size();
  if (times <= kMaxRelaxationTimes) return;
  refuse("relaxation of the regions",
         std::to_string(times) + " relaxation times, a library has at most " +
             std::to_string(kMaxRelaxationTimes),
         "give regions the same times, or fewer");
}

void check_settings(const FitSettings& settings) {
  const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
  if (!positive(settings.relative_tolerance) ||
      !(std::isnan(settings.absolute_tolerance) || positive(settings.absolute_tolerance))) {
    refuse("fit settings", "a tolerance is not positive", "give positive tolerances");
  }
  if (settings.max_knots < 2) {
    refuse("fit settings", "max_knots = " + std::to_string(settings.max_knots), "allow at least 2");
  }
}

/// Largest distance of the lateral response from any single path. It includes what azimuths and
/// depths share in one response, or, when decoupled, the loss by averaging over them.
double lateral_error(const NodeResponse& node, ResponseKind kind, const SiteCurves& site) {
  const LeaningResponse rendered(node, kind);
  double largest = 0;
  for (const CurvePath& path : site.paths) {
    SiteCurves one;
    one.paths.push_back(path);
    for (const auto& samples : lateral_paths(one)) {
      for (const ForceSample& sample : samples) {
        const double force =
            rendered.drag_force(path.lateral_depth, sample.displacement, path.direction);
        largest = std::max(largest, std::abs(force - sample.force));
      }
    }
  }
  return largest;
}

/// Largest error of the mesh in the samples of the paths of a kind; NaN when unknown.
double mesh_error(const SiteCurves& site, PathKind kind) {
  double largest = kUnknown;
  for (const CurvePath& path : site.paths)
    if (path.kind == kind)
      for (const CurveSample& sample : path.samples)
        largest = std::fmax(largest, sample.mesh_error);
  return largest;
}

PressingTool tool_of(const Curves& curves) {
  return curves.tool.friction == "frictionless" ? PressingTool::Slips : PressingTool::Sticks;
}

double normal_error(const NodeResponse& node, ResponseKind kind, const SiteCurves& site,
                    PressingTool tool) {
  const runtime::CompiledCurve rendered(node.normal);
  const LeaningResponse lean(node, kind);
  double largest = 0;
  for (const ForceSample& sample : normal_samples(site)) {
    double force = rendered.force(sample.displacement);
    if (tool == PressingTool::Sticks) force += lean.normal_force(sample.displacement);
    largest = std::max(largest, std::abs(force - sample.force));
  }
  return largest;
}

/// The lean of a node, and its normal response again: a straight press that sticks feels both.
void add_lean(const SiteCurves& site, const Vec3& inward, ResponseKind kind, PressingTool tool,
              const CurveFitSettings& curve, const std::string& where, NodeResponse& node) {
  node.lean = fit_lean(site, inward, node, kind, tool);
  if (node.lean == std::array<float, 3>{} || tool == PressingTool::Slips) return;
  const auto samples = less_lean(normal_samples(site), LeaningResponse(node, kind));
  node.normal = fit_curve(samples, curve, where).curve;
  node.normal_error = normal_error(node, kind, site, tool);
}

NodeResponse fit_site(const SiteCurves& site, const Vec3& inward, PressingTool tool,
                      const FitSettings& settings) {
  const std::string where = site_name(site.vertex);
  const std::string normal_name = where + ", normal response";
  const CurveFitSettings pressed{settings.relative_tolerance, settings.absolute_tolerance,
                                 settings.max_knots, true};
  const CurveFit normal = fit_curve(normal_samples(site), pressed, normal_name);
  CurveFitSettings curve = pressed;
  curve.zero_first_slope = false;
  NodeResponse node{ResponseStatus::Fitted, normal.curve, {}, normal.largest_error, 0, {}};
  if (settings.kind == ResponseKind::Coupled) {
    if (settings.soft_axes) node.soft_axis = fit_soft_axis(site, inward);
    CoupledLateral coupled =
        fit_coupled(site, vec3_of(node.soft_axis), normal_reach(site), curve, where);
    node.lateral = std::move(coupled.lateral);
    node.coupling = std::move(coupled.coupling);
  } else {
    const auto mean = mean_lateral(lateral_paths(at_every_depth(site)));
    node.lateral = fit_curve(mean, curve, where + ", lateral response").curve;
  }
  if (settings.lean) add_lean(site, inward, settings.kind, tool, pressed, normal_name, node);
  node.lateral_error = lateral_error(node, settings.kind, site);
  node.normal_mesh_error = mesh_error(site, PathKind::Normal);
  node.lateral_mesh_error = mesh_error(site, PathKind::Lateral);
  return node;
}

Library surface_library(const Body& body, const Curves& curves) {
  Library library;
  library.name = body.name;
  library.tool_shape = curves.tool.shape;
  library.tool_radius = curves.tool.radius;
  set_response_surface(body, library);
  library.responses.resize(library.positions.size());
  library.provenance = curves.provenance;
  library.relaxation_times = curves.relaxation.times_s;
  return library;
}

double force_at_end(const runtime::CompiledCurve& curve) {
  return curve.force(curve.last_knot());
}

void scale(NodeResponse& node, ResponseKind kind, double factor) {
  // Responses without samples of their own get the change as an additional error.
  double largest_weight = 1;
  if (kind == ResponseKind::Coupled)
    largest_weight = force_at_end({node.coupling.curve, static_cast<double>(node.coupling.base)});
  const double change = std::abs(factor - 1);
  node.normal_error += change * force_at_end(runtime::CompiledCurve(node.normal));
  node.lateral_error +=
      change * largest_weight * force_at_end(runtime::CompiledCurve(node.lateral));
  for (ResponseCurve* curve : {&node.normal, &node.lateral})
    for (float& slope : curve->slope) slope *= static_cast<float>(factor);
}

/// The stated errors remain those at the nodes, where the samples are.
void scale_between_nodes(const Curves& curves, Library& library) {
  const std::vector<double> factors = factors_between_nodes(library, 0.5 * curves.depth);
  for (std::size_t v = 0; v < factors.size(); ++v)
    if (library.responses[v].status != ResponseStatus::Hole)
      scale(library.responses[v], library.kind, factors[v]);
  for (const SiteCurves& site : curves.sites) {
    NodeResponse& node = library.responses[static_cast<std::size_t>(site.vertex)];
    if (node.status != ResponseStatus::Fitted) continue;
    node.normal_error = normal_error(node, library.kind, site, tool_of(curves));
    node.lateral_error = lateral_error(node, library.kind, site);
  }
}

std::vector<std::int32_t> vertices_of(const Curves& curves) {
  std::vector<std::int32_t> vertices;
  for (const SiteCurves& site : curves.sites) vertices.push_back(site.vertex);
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

}  // namespace

bool usable(const SiteCurves& site, double depth) {
  if (site.status == SiteStatus::Failed) return false;
  return normal_reach(site) >= 0.5 * depth * (1 - 1e-9) && normal_reach(site) > 0 &&
         !lateral_paths(site).empty();
}

Library fit(const Body& body, const Curves& curves, const FitSettings& settings) {
  check_settings(settings);
  check_curves(body, curves);
  check_relaxation_times(curves);
  Library library = surface_library(body, curves);
  library.kind = settings.kind;
  std::size_t fitted = 0;
  for (const SiteCurves& site : curves.sites) {
    if (!usable(site, curves.depth)) continue;
    const auto vertex = static_cast<std::size_t>(site.vertex);
    NodeResponse& node = library.responses[vertex];
    node = fit_site(site, library.inward[vertex], tool_of(curves), settings);
    if (library.relaxes()) node.relaxation = relaxation_fractions(site, curves.relaxation);
    ++fitted;
  }
  if (fitted == 0) {
    refuse(
        "curves of body '" + body.name + "'",
        "no site has a normal response over half of the depth and a lateral response",
        "see the reasons recorded with the sites; precompute with lateral depths and azimuths, or "
        "for measured presses give path.lateral_ratio in the sidecar");
  }
  if (library.triangles.empty()) {
    refuse("body '" + body.name + "'", "every response triangle touches a support",
           "support a smaller part of the surface");
  }
  if (settings.interpolate) interpolate_rest(body, vertices_of(curves), settings, library);
  if (settings.fill_holes) fill_holes(library, settings);
  if (settings.between_nodes) scale_between_nodes(curves, library);
  return library;
}

}  // namespace palpate::fitting
