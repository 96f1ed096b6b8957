// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/discretize.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <string>
#include <utility>

#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/checks.hpp"
#include "mesher/geometry/cgal_guard.hpp"
#include "mesher/geometry/quality.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/skin/curve_edges.hpp"
#include "mesher/skin/remesh.hpp"
#include "mesher/support/follow_outlines.hpp"
#include "mesher/support/outlines.hpp"
#include "mesher/support/supports.hpp"
#include "mesher/volume/delaunay.hpp"
#include "mesher/volume/fill.hpp"
#include "mesher/volume/inclusions.hpp"

namespace palpate::mesher {
namespace {

/// One way to make the tetrahedra.
struct Way {
  std::string name;
  std::function<Discretization()> run;
};

int subdivisions_of(const Settings& settings) {
  return std::max(1, static_cast<int>(std::lround(settings.patch_spacing / settings.element_size)));
}

Discretization by_remeshing(const Settings& settings, const Surface& skin,
                            const std::vector<SupportedPart>& parts,
                            const std::vector<Surface>& inclusions) {
  const std::string where = settings.surface.path.string();
  check_inclusions(settings, skin, inclusions);
  std::vector<std::vector<Edge>> outlines;
  for (const SupportedPart& part : parts) outlines.push_back(part.outline);
  Discretization result;
  result.skin = remesh(skin,
                       {settings.patch_spacing, subdivisions_of(settings), settings.feature_angle,
                        settings.curved_facets, outlines},
                       where, settings.log);
  const std::vector<Surface> remeshed = remesh_inclusions(settings, inclusions);
  const Surface shells = join_shells(settings, result.skin.boundary, remeshed);
  const Filling filling = fill(shells, settings.interior_coarsening * settings.element_size, where);
  if (filling.cut_short) {
    warn(settings.log,
         "the refinement reached its limit of nodes and was stopped; see the quality");
  }
  result.volume = with_regions(settings, filling, remeshed);
  check_elements(result.volume, where);
  check_filled(result.volume, result.skin.boundary, where);
  return result;
}

/// Moves nodes of the boundary onto the outlines of supports as far as there is room.
void follow(const Settings& settings, const OutlinedSurface& outlined,
            const std::vector<Triangle>& boundary, VolumeMesh& volume, std::size_t kept = 0) {
  const std::size_t crossing =
      follow_outlines(outlined, boundary, volume.tetrahedra, volume.nodes, kept);
  if (crossing > 0)
    note(settings.log, text("supports: ", counted(crossing, "edge"),
                            " of the body still cross their outlines: facets there end near them"));
}

/// Puts the points of the skin where the nodes of the volume have moved, and the middles of the
/// curved edges there on the surface again.
void follow_nodes(const std::vector<Vec3>& nodes, const Surface& input, NestedSurface& skin) {
  std::vector<bool> moved(skin.boundary.points.size());
  for (std::size_t i = 0; i < moved.size(); ++i) {
    moved[i] = norm(nodes[i] - skin.boundary.points[i]) > 0;
    skin.boundary.points[i] = nodes[i];
  }
  const auto has_moved = [&](const CurvedEdge& edge) {
    return moved[to_index(edge.ends[0])] || moved[to_index(edge.ends[1])];
  };
  if (skin.curved.empty()) return;
  std::erase_if(skin.curved, has_moved);
  const std::vector<CurvedEdge> all = curve_edges(skin.boundary, input);
  std::copy_if(all.begin(), all.end(), std::back_inserter(skin.curved), has_moved);
  std::sort(skin.curved.begin(), skin.curved.end(),
            [](const CurvedEdge& a, const CurvedEdge& b) { return a.ends < b.ends; });
}

/// Remeshes without regard to supports, where edges along their outlines would have no room. The
/// response vertices stay, so that they do not depend on the elements.
Discretization by_remeshing_and_moving(const Settings& settings, const Surface& skin,
                                       const OutlinedSurface& outlined,
                                       const std::vector<Surface>& inclusions) {
  Discretization result = by_remeshing(settings, skin, {}, inclusions);
  follow(settings, outlined, result.skin.boundary.triangles, result.volume,
         result.skin.response.points.size());
  follow_nodes(result.volume.nodes, skin, result.skin);
  check_nesting(result.skin, settings.patch_spacing, settings.surface.path.string());
  return result;
}

Discretization by_refinement(const Settings& settings, const Surface& skin,
                             const OutlinedSurface& outlined,
                             const std::vector<Surface>& inclusions) {
  const std::string where = settings.surface.path.string();
  DelaunaySettings delaunay;
  delaunay.element_size = settings.element_size;
  delaunay.interior_coarsening = settings.interior_coarsening;
  delaunay.surface_coarsening = coarsening_at_supports(settings, skin);
  delaunay.most_volume_change = kMostVolumeChange;
  delaunay.largest_dihedral = kLargestDihedral;
  delaunay.log = settings.log;
  DelaunayReport report;
  VolumeMesh volume = mesh_domain(domain_of(settings, skin, inclusions), delaunay, where, report);
  follow(settings, outlined, boundary_of(volume, where), volume);
  const double spacing = subdivisions_of(settings) > 1 ? settings.patch_spacing : 0;
  Discretization result = with_response(std::move(volume), spacing, settings.feature_angle, where);
  if (settings.curved_facets) result.skin.curved = curve_edges(result.skin.boundary, skin);
  note(settings.log,
       text("Delaunay refinement: the surface of the body lies within ",
            millimetres(std::max(report.distance_to_surface, report.distance_to_mesh)),
            " of the file; its volume differs by ", 100 * report.volume_change, " %"));
  return result;
}

bool has_void(const Settings& settings) {
  return std::any_of(settings.inclusions.begin(), settings.inclusions.end(),
                     [](const SurfaceFile& inclusion) { return inclusion.is_void; });
}

/// Isotropic remeshing knows one size of facets, and neither layers nor voids.
bool needs_refinement(const Settings& settings) {
  return !settings.layers.empty() || has_void(settings) || settings.support_coarsening > 1;
}

/// @throws Error(Geometry) when the mesh would not serve.
void check_discretization(const Discretization& d, const Settings& settings, const Surface& skin,
                          const std::string& where) {
  const Quality quality = measure_quality(d.volume.nodes, d.volume.tetrahedra);
  if (quality.largest_dihedral > kLargestDihedral)
    refuse_geometry(where,
                    text("a tetrahedron at ", position_text(quality.largest_dihedral_at),
                         " has a dihedral angle of ", quality.largest_dihedral, " degrees, over ",
                         kLargestDihedral),
                    "change patch_spacing or element_size a little, or smooth the surface there");
  if (has_void(settings)) return;  // the volume inside the skin is not that of the body
  const double enclosed = signed_volume(skin);
  const double change = signed_volume(d.skin.boundary) / enclosed - 1;
  if (std::abs(change) > kMostVolumeChange)
    refuse_geometry(where,
                    text("the volume of the body differs from that inside the surface by ",
                         100 * change, " %, more than ", 100 * kMostVolumeChange, " %"),
                    "reduce element_size");
}

std::vector<Way> ways(const Settings& settings, const Surface& skin,
                      const OutlinedSurface& outlined, const std::vector<Surface>& inclusions) {
  const bool has_outline =
      std::any_of(outlined.parts.begin(), outlined.parts.end(),
                  [](const SupportedPart& part) { return !part.outline.empty(); });
  std::vector<Way> result;
  if (settings.method != MeshMethod::Delaunay && !needs_refinement(settings)) {
    if (has_outline) {
      result.push_back(
          {"isotropic remeshing along the outlines of supports",
           [&] { return by_remeshing(settings, outlined.surface, outlined.parts, inclusions); }});
      result.push_back({"isotropic remeshing", [&] {
                          return by_remeshing_and_moving(settings, skin, outlined, inclusions);
                        }});
    } else {
      result.push_back(
          {"isotropic remeshing", [&] { return by_remeshing(settings, skin, {}, inclusions); }});
    }
  }
  if (settings.method != MeshMethod::Isotropic)
    result.push_back({"Delaunay refinement",
                      [&] { return by_refinement(settings, skin, outlined, inclusions); }});
  return result;
}

}  // namespace

Discretization discretize(const Settings& settings, const Surface& skin,
                          const std::vector<Surface>& inclusions) {
  const std::string where = settings.surface.path.string();
  if (settings.method == MeshMethod::Isotropic && needs_refinement(settings)) {
    refuse(where, "isotropic remeshing makes neither layers, voids nor coarser supports",
           "remove mesh.method, or the layers, voids and support_coarsening");
  }
  const OutlinedSurface outlined = with_outlines(skin, settings);
  std::string problems, remedy;
  for (const Way& way : ways(settings, skin, outlined, inclusions)) {
    try {
      Discretization result;
      guard_cgal(where, "smooth the surface, or change element_size a little",
                 [&] { result = way.run(); });
      check_discretization(result, settings, skin, where);
      return result;
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::Configuration) throw;
      note(settings.log, text(way.name, " does not make a sound mesh: ", error.problem()));
      problems += text(problems.empty() ? "" : "; ", way.name, ": ", error.problem());
      remedy = error.remedy();
    }
  }
  refuse_geometry(where, "the surface cannot be meshed: " + problems, remedy);
}

}  // namespace palpate::mesher
