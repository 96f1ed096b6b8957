// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/convergence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/pipeline/campaign_sites.hpp"
#include "app/pipeline/settings.hpp"
#include "fem/campaign/campaign.hpp"
#include "format/crash_safe_file.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"

namespace palpate::app {
namespace {

constexpr double kRefinement = 1.4;

/// Three sites spread over the body as far as its numbering is.
std::vector<std::int32_t> three_of(const std::vector<std::int32_t>& all) {
  std::vector<std::int32_t> some;
  for (const std::size_t sixth : {std::size_t{1}, std::size_t{3}, std::size_t{5}})
    some.push_back(all[sixth * all.size() / 6]);
  some.erase(std::unique(some.begin(), some.end()), some.end());
  return some;
}

double last_force(const CurvePath& path, double end) {
  const CurveSample& sample = path.samples.back();
  if (path.samples.size() < 2 || sample.displacement < end * (1 - 1e-9))
    return std::numeric_limits<double>::quiet_NaN();
  return dot(sample.force - path.samples.front().force, path.direction);
}

/// Appends the forces of a site at the ends of the normal and of the lateral path.
void add_forces(const SiteCurves& site, const fem::IndentationSettings& settings,
                std::vector<ConvergenceRow>& rows) {
  const auto add = [&](const std::string& quantity, double force) {
    for (ConvergenceRow& row : rows) {
      if (row.vertex != site.vertex || row.quantity != quantity) continue;
      row.forces.push_back(force);
      return;
    }
    rows.push_back({site.vertex, quantity, {force}, {}});
  };
  double normal = std::numeric_limits<double>::quiet_NaN(), lateral = normal;
  for (const CurvePath& path : site.paths) {
    if (path.kind == PathKind::Normal) normal = last_force(path, settings.depth);
    if (path.kind == PathKind::Lateral) lateral = last_force(path, settings.lateral_travel);
  }
  add("normal force at " + length_text(settings.depth), normal);
  if (settings.lateral_depths.empty()) return;
  add(fmt::format("lateral force after {} at {}", length_text(settings.lateral_travel),
                  length_text(settings.lateral_depths.back())),
      lateral);
}

/// All meshes must have the same response surface; only the elements are finer.
void check_same_sites(const Body& first, const Body& finer, const std::string& where) {
  bool same = first.response.node.size() == finer.response.node.size();
  for (std::size_t v = 0; same && v < first.response.node.size(); ++v) {
    const auto at = [&](const Body& body) {
      return body.nodes[static_cast<std::size_t>(body.response.node[v])];
    };
    same = norm(at(first) - at(finer)) == 0;
  }
  if (same) return;
  throw Error(ErrorKind::Geometry, where,
              "the finer mesh has other response vertices, so that their forces cannot be compared",
              "set mesh.method = \"isotropic\" where it is not, or change patch_spacing a little");
}

/// The body with elements of each size. They are all made before any is pressed: a fault of the
/// last is not to cost the campaigns before it.
std::vector<Body> compared_bodies(mesher::Settings meshing, const std::vector<double>& sizes,
                                  const std::string& where) {
  meshing.skin_size = meshing.element_size;
  std::vector<Body> bodies;
  for (const double size : sizes) {
    meshing.element_size = size;
    bodies.push_back(mesher::mesh(meshing));
    check_same_sites(bodies.front(), bodies.back(), where);
    // Mean normals of smaller facets are others, and a force along another direction is no closer
    // to the limit.
    bodies.back().response.inward = bodies.front().response.inward;
  }
  return bodies;
}

/// The sites that all bodies have.
std::vector<std::int32_t> common_sites(const std::vector<Body>& bodies) {
  std::vector<std::int32_t> common = sites_of(bodies.front());
  std::erase_if(common, [&](std::int32_t v) {
    return std::any_of(bodies.begin(), bodies.end(), [v](const Body& body) {
      return body.response.is_site[static_cast<std::size_t>(v)] == 0;
    });
  });
  return common;
}

/// Those that were asked for, or three.
std::vector<std::int32_t> chosen_sites(const std::vector<std::int32_t>& wanted,
                                       const std::vector<Body>& bodies, const std::string& where) {
  const std::vector<std::int32_t> common = common_sites(bodies);
  if (common.empty()) {
    throw Error(ErrorKind::Geometry, where, "no response vertex is a site on all of the meshes",
                "press less deep, or by a smaller tool");
  }
  if (wanted.empty()) return three_of(common);
  for (const std::int32_t v : wanted) {
    if (std::find(common.begin(), common.end(), v) != common.end()) continue;
    throw Error(ErrorKind::Configuration, fmt::format("--sites {}", v),
                "the vertex is not a site on all of the meshes",
                "choose others, or leave --sites out");
  }
  return wanted;
}

void refuse_meshes_from_files(const Workspace& space) {
  if (space.c.mesh.volume_mesh.path.empty() && space.c.mesh.image.path.empty()) return;
  refuse("case " + space.c.name,
         "--convergence makes finer meshes of a surface, and this body is read as a mesh or an "
         "image",
         "for a mesh, compare cases of finer mesh files; for an image, those of a smaller "
         "element_size");
}

ConvergenceOfForce convergence_of(const ConvergenceRow& row) {
  return {row.vertex,      row.quantity,    row.forces,      row.limit.trusted,
          row.limit.order, row.limit.value, row.limit.error, row.limit.bound};
}

}  // namespace

std::vector<double> finer_element_sizes(double patch_spacing, double element_size, int levels) {
  std::vector<double> sizes;
  int divisions = std::max(1, static_cast<int>(std::lround(patch_spacing / element_size)));
  for (int level = 0; level < levels; ++level) {
    sizes.push_back(patch_spacing / divisions);
    divisions = std::max(divisions + 1, static_cast<int>(std::lround(kRefinement * divisions)));
  }
  return sizes;
}

std::string convergence_csv(const ConvergenceTable& table) {
  std::string out = "vertex,quantity";
  for (const double size : table.element_sizes) out += fmt::format(",force_N_at_{}_m", size);
  out += ",order,extrapolated_force_N,error_of_the_case,bound_of_the_error,follows_a_power\n";
  for (const ConvergenceRow& row : table.rows) {
    out += fmt::format("{},{}", row.vertex, row.quantity);
    for (const double force : row.forces) out += fmt::format(",{}", force);
    out += fmt::format(",{},{},{},{},{}\n", row.limit.order, row.limit.value, row.limit.error,
                       row.limit.bound, row.limit.trusted ? 1 : 0);
  }
  return out;
}

ConvergenceTable run_convergence(const Workspace& space, int levels,
                                 const std::vector<std::int32_t>& wanted, const EventSink& emit) {
  if (levels < 3) {
    throw Error(ErrorKind::Configuration, fmt::format("--convergence {}", levels),
                "an order of convergence needs at least three meshes", "give 3 or more");
  }
  refuse_meshes_from_files(space);
  prepare_output(space.out);
  const mesher::Settings meshing = mesh_settings(space);
  fem::CampaignSettings campaign = campaign_settings(space);
  fem::IndentationSettings& paths = campaign.indentation;
  if (paths.lateral_depths.size() > 1)
    paths.lateral_depths = {
        *std::max_element(paths.lateral_depths.begin(), paths.lateral_depths.end())};
  if (paths.azimuths.size() > 1) paths.azimuths = {paths.azimuths.front()};
  paths.drag_across = false;

  ConvergenceTable table;
  table.element_sizes = finer_element_sizes(meshing.patch_spacing, meshing.element_size, levels);
  const std::vector<Body> bodies = compared_bodies(meshing, table.element_sizes, space.c.name);
  campaign.sites = chosen_sites(wanted, bodies, space.c.name);
  for (std::size_t level = 0; level < bodies.size(); ++level) {
    table.nodes.push_back(static_cast<std::int64_t>(bodies[level].nodes.size()));
    fem::CampaignReport report;
    const Curves curves = fem::run_campaign(bodies[level], campaign, report);
    for (const SiteCurves& site : curves.sites) add_forces(site, paths, table.rows);
    emit(ConvergenceLevel{table.element_sizes[level], report.unknowns,
                          report.cpu_seconds / static_cast<double>(curves.sites.size())});
  }
  for (ConvergenceRow& row : table.rows) {
    row.limit = extrapolate(table.element_sizes, row.forces);
    emit(convergence_of(row));
  }
  const auto file = space.out / "convergence.csv";
  write_file_crash_safely(file, convergence_csv(table));
  emit(FileWritten{"convergence", file});
  return table;
}

}  // namespace palpate::app
