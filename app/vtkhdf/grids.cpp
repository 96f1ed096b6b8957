// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/vtkhdf/grids.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fitting/response/leaning_response.hpp"
#include "format/error.hpp"
#include "format/tangent_frame.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::vtkhdf {
namespace {

std::string region_legend(const std::vector<std::string>& names) {
  std::string legend = "Material region:";
  for (std::size_t i = 0; i < names.size(); ++i) {
    legend += (i == 0 ? " " : ", ") + std::to_string(i) + " " + names[i];
  }
  return legend + ".";
}

/// Force and slope at one deflection, for all vertices; NaN at holes.
struct Samples {
  std::vector<double> force;
  std::vector<double> slope;

  /// A factor of a curve and what lean and soft axis add to it, over a deflection.
  template <class Added>
  void add(double factor, const runtime::CompiledCurve& curve, const Added& added,
           double deflection) {
    constexpr double kDifference = 1e-3;
    const double step = kDifference * deflection;
    const runtime::CurveValue own = curve.evaluate(deflection);
    force.push_back(factor * own.force + added(deflection));
    slope.push_back(factor * own.slope +
                    (added(deflection + step) - added(deflection - step)) / (2 * step));
  }
  void add_hole() {
    force.push_back(std::numeric_limits<double>::quiet_NaN());
    slope.push_back(std::numeric_limits<double>::quiet_NaN());
  }
};

/// Straight presses to a depth, as they are rendered.
Samples presses(const Library& library, double depth) {
  Samples samples;
  for (const NodeResponse& node : library.responses) {
    if (node.status == ResponseStatus::Hole) {
      samples.add_hole();
      continue;
    }
    const runtime::CompiledCurve g(node.normal);
    const fitting::LeaningResponse leaning(node, library.kind);
    samples.add(
        1, g, [&](double z) { return leaning.normal_force(z); }, depth);
  }
  return samples;
}

/// Drags at a depth across the soft axis: as far as the depth, or to the last knot.
Samples drags(const Library& library, double depth) {
  Samples samples;
  for (std::size_t v = 0; v < library.responses.size(); ++v) {
    const NodeResponse& node = library.responses[v];
    if (node.status == ResponseStatus::Hole) {
      samples.add_hole();
      continue;
    }
    const Vec3 across = cross(library.inward[v], vec3_of(node.soft_axis));
    const Vec3 direction =
        norm(across) > 0 ? (1 / norm(across)) * across : tangent_frame(library.inward[v])[0];
    const fitting::LeaningResponse leaning(node, library.kind);
    const runtime::CompiledCurve h(node.lateral), w = fitting::coupling_of(node, library.kind);
    const double weight = w.pieces().empty() ? 1 : w.evaluate(depth).force;
    const bool straight = norm(vec3_of(node.lean)) == 0 && norm(vec3_of(node.soft_axis)) == 0;
    const auto added = [&](double d) {
      return straight ? 0 : leaning.drag_force(depth, d, direction) - weight * h.force(d);
    };
    samples.add(weight, h, added, std::min(depth, static_cast<double>(node.lateral.knot.back())));
  }
  return samples;
}

template <class Record, class Field>
auto column_of(const std::vector<Record>& records, Field Record::*member) {
  using Value = std::conditional_t<std::is_same_v<Field, double>, double, std::int32_t>;
  std::vector<Value> values;
  values.reserve(records.size());
  for (const Record& record : records) values.push_back(static_cast<Value>(record.*member));
  return values;
}

void add_certificate(const std::vector<TriangleCertificate>& triangles, Grid& grid) {
  grid.cell_data.push_back({"stick", "N/m", "L_stick: bound with the contact point fixed.",
                            column_of(triangles, &TriangleCertificate::stick)});
  grid.cell_data.push_back({"slip", "N/m", "L_slip: bound while sliding.",
                            column_of(triangles, &TriangleCertificate::slip)});
  grid.cell_data.push_back({"kappa", "1/m", "Bound on the turning rate of n.",
                            column_of(triangles, &TriangleCertificate::kappa)});
  grid.cell_data.push_back({"cos_theta", "1",
                            "Cosine of the largest angle between n and the facet normal.",
                            column_of(triangles, &TriangleCertificate::cos_theta)});
  grid.cell_data.push_back({"sliding_passive", "1", "1 where sliding needs no correction.",
                            column_of(triangles, &TriangleCertificate::sliding_passive)});
}

}  // namespace

Grid body_grid(const Body& body) {
  Grid grid;
  grid.description = "Body " + body.name + ", in its reference position.";
  grid.points = body.nodes;
  grid.add_cells(body.tetrahedra);
  grid.provenance = body.provenance;
  std::vector<std::int32_t> fixed(body.nodes.size(), 0), response(fixed), site(fixed);
  std::vector<Vec3> inward(body.nodes.size(), Vec3{});
  for (const std::int32_t node : body.fixed_nodes) fixed[static_cast<std::size_t>(node)] = 1;
  for (std::size_t vertex = 0; vertex < body.response.node.size(); ++vertex) {
    const auto node = static_cast<std::size_t>(body.response.node[vertex]);
    response[node] = 1;
    site[node] = body.response.is_site[vertex];
    inward[node] = body.response.inward[vertex];
  }
  grid.point_data = {{"fixed", "1", "1 at a fixed node.", std::move(fixed)},
                     {"response", "1", "1 at a response vertex.", std::move(response)},
                     {"site", "1", "1 where the tool may be pressed.", std::move(site)},
                     {"inward", "1", "u^z at a response vertex, else 0.", std::move(inward)}};
  grid.cell_data = {{"region", "1", region_legend(body.region_names), body.tetrahedron_region}};
  return grid;
}

Grid deformed_grid(const Body& body, const DeformedFields& fields) {
  const bool fits = fields.displacement.size() == body.nodes.size() &&
                    fields.strain_energy_density.size() == body.tetrahedra.size() &&
                    fields.pressure.size() == body.tetrahedra.size() &&
                    fields.smooth_pressure.size() == body.tetrahedra.size();
  if (!fits) {
    throw Error(ErrorKind::Internal, "deformed state of " + body.name,
                "the sizes of its fields differ from that of the body",
                "report this as a defect of palpate");
  }
  Grid grid = body_grid(body);
  grid.description = "Body " + body.name + ", pressed.";
  grid.point_data.push_back({"displacement", "m", "u = x - X of each node.", fields.displacement});
  grid.cell_data.push_back(
      {"strain_energy_density", "J/m^3", "Mean over the element.", fields.strain_energy_density});
  grid.cell_data.push_back({"pressure", "Pa", "Element mean, tension positive.", fields.pressure});
  grid.cell_data.push_back(
      {"smooth_pressure", "Pa",
       "Projection of the pressure onto continuous functions, without checkerboards.",
       fields.smooth_pressure});
  return grid;
}

Grid library_grid(const Library& library, double depth) {
  if (!(std::isfinite(depth) && depth > 0)) {
    throw Error(ErrorKind::Configuration, "depth of the exported forces",
                std::to_string(depth) + " m is not positive and finite", "give a depth above 0");
  }
  Grid grid;
  grid.description = "Response library " + library.name + ".";
  grid.points = library.positions;
  grid.add_cells(library.triangles);
  grid.provenance = library.provenance;
  const std::string at = " at a depth of " + std::to_string(depth * 1e3) + " mm";
  const std::string drag = at + ", of a drag as far as that or to the last knot, as rendered.";
  Samples normal = presses(library, depth), lateral = drags(library, depth);
  grid.point_data = {
      {"inward", "1", "u^z, into the body.", library.inward},
      {"status", "1", "0 fitted, 1 interpolated, 2 hole.",
       column_of(library.responses, &NodeResponse::status)},
      {"normal_force", "N", "Of a straight press" + at + ", as rendered.", std::move(normal.force)},
      {"normal_stiffness", "N/m", "Slope of the normal force" + at + ".", std::move(normal.slope)},
      {"lateral_force", "N", "Along the drag" + drag, std::move(lateral.force)},
      {"lateral_stiffness", "N/m", "Slope of the lateral force" + drag, std::move(lateral.slope)},
      {"normal_error", "N", "Largest |fit - sample|, normal.",
       column_of(library.responses, &NodeResponse::normal_error)},
      {"lateral_error", "N", "Largest |fit - sample|, lateral.",
       column_of(library.responses, &NodeResponse::lateral_error)}};
  if (!library.certificate.triangles.empty()) {
    add_certificate(library.certificate.triangles, grid);
  }
  return grid;
}

}  // namespace palpate::vtkhdf
