// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/mesher.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "format/to_index.hpp"
#include "mesher/checks.hpp"
#include "mesher/discretize.hpp"
#include "mesher/geometry/quality.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/read/image/image_field.hpp"
#include "mesher/read/mesh/read_volume_mesh.hpp"
#include "mesher/read/read_surface.hpp"
#include "mesher/region_checks.hpp"
#include "mesher/repair/change.hpp"
#include "mesher/response/cavities.hpp"
#include "mesher/response/response.hpp"
#include "mesher/skin/curved_skin.hpp"
#include "mesher/skin/smooth.hpp"
#include "mesher/support/supports.hpp"
#include "mesher/volume/delaunay.hpp"
#include "mesher/volume/discretization.hpp"

namespace palpate::mesher {
namespace {

/// Largest edge of a smooth surface over the size of the skin: its facets bend less than elements
/// do.
constexpr double kSmoothFacets = 0.5;

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

/// The surface of the file, smooth where the settings say so.
Surface outer_surface(const Settings& settings) {
  Surface facets = read_surface(settings.surface, settings.log, settings.on_repair);
  if (!settings.surface.smooth) return facets;
  const std::string where = settings.surface.path.string();
  const SmoothSettings smoothing{settings.feature_angle, settings.patch_spacing,
                                 kSmoothFacets * settings.size_of_skin()};
  Surface surface = smooth(facets, smoothing, where);
  const Change change = change_between(surface, facets, std::numeric_limits<double>::infinity());
  note(settings.log, text("smooth surface: up to ", millimetres(change.distance),
                          " from the facets of the file, at ", position_text(change.at)));
  return surface;
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
                 const Labels& labels) {
  body.boundary = nested.boundary.triangles;
  Marks constrained = fix_nodes(body, settings, labels, nested.boundary);
  add_marks(constrained, set_foundation(body, settings, labels, nested.boundary));
  set_response(body, nested, constrained, settings);
  exclude_cavities(body, nested.boundary, settings.log);
  keep_sites_in_zones(body, settings, labels, nested.boundary);
  check_supports(body, settings, nested.boundary);
  exclude_thin_sites(body, settings, nested.boundary);
  check_sites(body, settings, nested.boundary);
}

/// The body of a filled skin.
Body body_of(Discretization made, const Settings& settings, const Labels& labels) {
  note_patches(settings, made.skin);
  Body body;
  body.name = settings.name.empty() ? settings.source().stem().string() : settings.name;
  set_surface(body, made.skin, settings, labels);
  body.nodes = std::move(made.volume.nodes);
  body.tetrahedra = std::move(made.volume.tetrahedra);
  body.tetrahedron_region = std::move(made.volume.region);
  body.region_names = std::move(made.volume.region_names);
  curve_skin(body, made.skin, settings);
  note(settings.log, summary(body));
  note(settings.log, "quality: " + summary(measure_quality(body.nodes, body.tetrahedra)));
  return body;
}

/// The tetrahedra of a file as they are; the response surface is a coarsening of their boundary.
Body body_of_volume_mesh(const Settings& settings) {
  const std::string where = settings.source().string();
  VolumeMesh volume = read_volume_mesh(settings.volume_mesh, settings.log);
  check_elements(volume, where);
  if (!settings.curved_facets) volume.curved_edges.clear();
  const double spacing = settings.all_nodes_are_sites ? 0 : settings.patch_spacing;
  Discretization made = with_response(std::move(volume), spacing, settings.feature_angle, where);
  check_sizes(settings, made.skin.boundary);
  const Surface boundary = made.skin.boundary;
  const NodeSets sets = std::move(made.volume.node_sets);
  return body_of(std::move(made), settings, {boundary, &sets});
}

/// The nodes of each region.
NodeSets region_sets(const VolumeMesh& volume) {
  NodeSets sets;
  for (std::size_t t = 0; t < volume.tetrahedra.size(); ++t) {
    auto& set = sets[volume.region_names[to_index(volume.region[t])]];
    set.insert(set.end(), volume.tetrahedra[t].begin(), volume.tetrahedra[t].end());
  }
  return sets;
}

/// Delaunay refinement of the regions of a segmentation.
Body body_of_image(const Settings& settings) {
  const std::string where = settings.source().string();
  const LabelField field = image_field(settings.image, settings.log);
  DelaunaySettings delaunay;
  delaunay.element_size = settings.element_size;
  delaunay.interior_coarsening = settings.interior_coarsening;
  delaunay.log = settings.log;
  DelaunayReport report;
  VolumeMesh volume = mesh_labels(field, delaunay, where, report);
  check_elements(volume, where);
  const double spacing = settings.all_nodes_are_sites ? 0 : settings.patch_spacing;
  Discretization made = with_response(std::move(volume), spacing, settings.feature_angle, where);
  check_sizes(settings, made.skin.boundary);
  const Surface boundary = made.skin.boundary;
  const NodeSets sets = region_sets(made.volume);
  return body_of(std::move(made), settings, {boundary, &sets});
}

}  // namespace

Body mesh(const Settings& settings) {
  check_settings(settings);
  if (!settings.volume_mesh.path.empty()) return body_of_volume_mesh(settings);
  if (!settings.image.path.empty()) return body_of_image(settings);
  const Surface skin = outer_surface(settings);
  const std::vector<Surface> inclusions = read_inclusions(settings);
  check_sizes(settings, skin);
  check_places(settings, skin, inclusions);
  check_thinness(settings, skin, inclusions);
  return body_of(discretize(settings, skin, inclusions), settings, {skin});
}

}  // namespace palpate::mesher
