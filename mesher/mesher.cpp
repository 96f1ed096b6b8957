// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/mesher.hpp"

#include <algorithm>
#include <utility>

#include "mesher/checks.hpp"
#include "mesher/discretize.hpp"
#include "mesher/geometry/quality.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/read/read_surface.hpp"
#include "mesher/response/cavities.hpp"
#include "mesher/response/response.hpp"
#include "mesher/skin/curved_skin.hpp"
#include "mesher/support/supports.hpp"

namespace palpate::mesher {
namespace {

void note_patches(const Settings& settings, const NestedSurface& skin) {
  note(settings.log, text("response surface: ", skin.response.points.size(), " vertices, ",
                          skin.response.triangles.size(), " triangles, on ",
                          skin.boundary.triangles.size(), " facets"));
}

void curve_skin(Body& body, const NestedSurface& skin, const Settings& settings) {
  body.curved_edges = skin.curved;
  const std::size_t reduced = reduce_bulges(body);
  if (reduced > 0) {
    note(settings.log, text(counted(reduced, "edge"), " of ", skin.curved.size(),
                            " bulge less than the skin: an element under them would be inverted"));
  }
}

std::vector<Surface> read_inclusions(const Settings& settings) {
  std::vector<Surface> inclusions;
  for (const SurfaceFile& file : settings.inclusions)
    inclusions.push_back(read_surface(file, settings.log));
  return inclusions;
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

/// Supports and sites on the surface of the body.
void set_surface(Body& body, const NestedSurface& nested, const Settings& settings,
                 const Surface& skin) {
  body.boundary = nested.boundary.triangles;
  Marks constrained = fix_nodes(body, settings, skin, nested.boundary);
  add_marks(constrained, set_foundation(body, settings, skin, nested.boundary));
  set_response(body, nested, constrained, settings);
  exclude_cavities(body, nested.boundary, settings.log);
  check_supports(body, settings, nested.boundary);
  exclude_thin_sites(body, settings, nested.boundary);
  check_sites(body, settings, nested.boundary);
}

}  // namespace

Body mesh(const Settings& settings) {
  check_settings(settings);
  const Surface skin = read_surface(settings.surface, settings.log);
  const std::vector<Surface> inclusions = read_inclusions(settings);
  check_sizes(settings, skin);

  Discretization made = discretize(settings, skin, inclusions);
  note_patches(settings, made.skin);
  Body body;
  body.name = settings.name.empty() ? settings.surface.path.stem().string() : settings.name;
  set_surface(body, made.skin, settings, skin);
  body.nodes = std::move(made.volume.nodes);
  body.tetrahedra = std::move(made.volume.tetrahedra);
  body.tetrahedron_region = std::move(made.volume.region);
  body.region_names = std::move(made.volume.region_names);
  curve_skin(body, made.skin, settings);

  note(settings.log, summary(body));
  note(settings.log, "quality: " + summary(measure_quality(body.nodes, body.tetrahedra)));
  return body;
}

}  // namespace palpate::mesher
