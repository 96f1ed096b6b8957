// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/mesher.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesher/checks.hpp"
#include "mesher/geometry/quality.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/read/read_surface.hpp"
#include "mesher/response/response.hpp"
#include "mesher/skin/curved_skin.hpp"
#include "mesher/skin/remesh.hpp"
#include "mesher/support/supports.hpp"
#include "mesher/volume/fill.hpp"
#include "mesher/volume/inclusions.hpp"

namespace palpate::mesher {
namespace {

NestedSurface remesh_skin(const Settings& settings, const Surface& skin) {
  const int subdivisions =
      std::max(1, static_cast<int>(std::lround(settings.patch_spacing / settings.element_size)));
  NestedSurface nested = remesh(
      skin, {settings.patch_spacing, subdivisions, settings.feature_angle, settings.curved_facets},
      settings.surface.path.string(), settings.log);
  note(settings.log, text("response surface: ", nested.response.points.size(), " vertices, ",
                          nested.response.triangles.size(), " triangles; each divided into ",
                          subdivisions, " x ", subdivisions, " facets"));
  return nested;
}

void curve_skin(Body& body, const NestedSurface& nested, const Settings& settings) {
  body.curved_edges = nested.curved;
  const std::size_t reduced = reduce_bulges(body);
  if (reduced > 0) {
    note(settings.log, text(counted(reduced, "edge"), " of ", nested.curved.size(),
                            " bulge less than the skin: an element under them would be inverted"));
  }
}

std::vector<Surface> read_inclusions(const Settings& settings) {
  std::vector<Surface> inclusions;
  for (const SurfaceFile& file : settings.inclusions)
    inclusions.push_back(read_surface(file, settings.log));
  return inclusions;
}

/// Fills the shells with tetrahedra and assigns their regions.
void fill_body(Body& body, const Settings& settings, const Surface& boundary,
               const std::vector<Surface>& inclusions) {
  const std::vector<Surface> remeshed = remesh_inclusions(settings, inclusions);
  const Surface shells = join_shells(settings, boundary, remeshed);
  Filling filling = fill(shells, settings.interior_coarsening * settings.element_size,
                         settings.surface.path.string());
  if (filling.cut_short) {
    note(settings.log,
         "WARNING: the refinement reached its limit of nodes and was stopped; see the quality");
  }
  set_regions(body, settings, filling, remeshed);
  body.nodes = std::move(filling.nodes);
  body.tetrahedra = std::move(filling.tetrahedra);
}

std::string summary(const Body& body) {
  const std::string foundation = body.foundation.empty()
                                     ? std::string()
                                     : text(body.foundation.size(), " facets on springs, ");
  const auto& is_site = body.response.is_site;
  return text("body: ", body.nodes.size(), " nodes, ", body.tetrahedra.size(), " tetrahedra, ",
              body.fixed_nodes.size(), " fixed nodes, ", foundation,
              std::count(is_site.begin(), is_site.end(), 1), " sites");
}

}  // namespace

Body mesh(const Settings& settings) {
  check_settings(settings);
  const std::string where = settings.surface.path.string();
  const Surface skin = read_surface(settings.surface, settings.log);
  const std::vector<Surface> inclusions = read_inclusions(settings);
  check_inclusions(settings, skin, inclusions);
  check_sizes(settings, skin);

  const NestedSurface nested = remesh_skin(settings, skin);
  Body body;
  body.name = settings.name.empty() ? settings.surface.path.stem().string() : settings.name;
  body.boundary = nested.boundary.triangles;
  Marks constrained = fix_nodes(body, settings, skin, nested.boundary);
  add_marks(constrained, set_foundation(body, settings, skin, nested.boundary));
  set_response(body, nested, constrained, settings);
  check_supports(body, settings, nested.boundary);
  check_sites(body, settings, nested.boundary);
  check_depth(body, settings, nested.boundary);

  fill_body(body, settings, nested.boundary, inclusions);
  check_elements(body, where);
  curve_skin(body, nested, settings);

  const Quality quality = measure_quality(body.nodes, body.tetrahedra);
  check_volumes(quality, nested.boundary, where);
  note(settings.log, summary(body));
  note(settings.log, "quality: " + summary(quality));
  return body;
}

}  // namespace palpate::mesher
