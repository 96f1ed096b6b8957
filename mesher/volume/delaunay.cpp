// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/delaunay.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/queries.hpp"
#include "mesher/volume/interfaces.hpp"
#include "mesher/volume/refine.hpp"
#include "mesher/volume/surface_oracle.hpp"

namespace palpate::mesher {
namespace {

/// Between the coordinates of the caller and those in which the largest dimension of the skin is 1.
struct Frame {
  Vec3 origin{};
  double scale = 1;  ///< m

  Vec3 metres(const Vec3& x) const { return origin + scale * x; }

  /// Rounded to 1e-9, so that bodies that differ by a factor have the same coordinates here in
  /// spite of the rounding of that factor.
  Vec3 scaled(const Vec3& x) const {
    constexpr double kGrid = 1 << 30;
    Vec3 y = (1 / scale) * (x - origin);
    for (double& c : y) c = std::round(c * kGrid) / kGrid;
    return y;
  }
  double scaled(double length) const { return static_cast<float>(length / scale); }
};

Frame frame_of(const Surface& skin) {
  return {bounds(skin.points).low, largest_dimension(skin.points)};
}

Domain scaled(const Domain& domain, const Frame& frame) {
  Domain result = domain;
  for (Vec3& x : result.skin.points) x = frame.scaled(x);
  for (Layer& layer : result.layers) layer.thickness = frame.scaled(layer.thickness);
  for (Enclosure& enclosure : result.enclosures)
    for (Vec3& x : enclosure.surface.points) x = frame.scaled(x);
  return result;
}

RefineSettings refine_settings(const DelaunaySettings& settings, const Frame& frame) {
  RefineSettings refine;
  const double h = frame.scaled(settings.element_size);
  // Edges are 1.25 times as long as the bound on the radius, in the mean.
  const double radius = 0.8 * h;
  const double inside = static_cast<float>(settings.interior_coarsening) * radius;
  refine.facet_size = [=, coarsening = settings.surface_coarsening](const Vec3& x) {
    return coarsening ? radius * std::max(1.0, coarsening(frame.metres(x))) : radius;
  };
  refine.cell_size = [=](const Vec3&) { return inside; };
  refine.seed_spacing = [=](const Vec3&) { return 2 * h; };
  refine.most_nodes = settings.most_nodes;
  return refine;
}

void measure_distances(const Domain& domain, const VolumeMesh& mesh, DelaunayReport& report) {
  const Surface boundary = boundary_surface(mesh);
  const auto largest = [](const Surface& from, const SurfaceQuery& to, double& distance, Vec3& at) {
    for (const Vec3& x : from.points) {
      const double d = norm(to.closest(x).point - x);
      if (d > distance) {
        distance = d;
        at = x;
      }
    }
  };
  largest(boundary, SurfaceQuery(domain.skin), report.distance_to_surface,
          report.distance_to_surface_at);
  largest(domain.skin, SurfaceQuery(boundary), report.distance_to_mesh, report.distance_to_mesh_at);
}

void check(const Domain&, const VolumeMesh& mesh, const DelaunaySettings& settings,
           const std::string& where, const DelaunayReport& report) {
  const std::string remedy = "reduce element_size, or repair the surface at this place";
  const auto pinched = non_manifold_nodes(boundary_facets(mesh.tetrahedra));
  if (!pinched.empty()) {
    refuse_geometry(
        where,
        text("the boundary of the mesh touches itself at ", counted(pinched.size(), "node"),
             ", one of them at ", millimetres(mesh.nodes[to_index(pinched.front())])),
        remedy);
  }
  if (std::abs(report.volume_change) > settings.most_volume_change) {
    refuse_geometry(where,
                    text("the volume of the mesh differs from that of the surface by ",
                         100 * report.volume_change, " %; the surface is farthest, ",
                         millimetres(report.distance_to_mesh), ", at ",
                         millimetres(report.distance_to_mesh_at)),
                    remedy);
  }
  if (report.quality.largest_dihedral > settings.largest_dihedral) {
    refuse_geometry(
        where, text("a dihedral angle of ", report.quality.largest_dihedral, " degrees"), remedy);
  }
}

}  // namespace

VolumeMesh mesh_domain(const Domain& domain, const DelaunaySettings& settings,
                       const std::string& where, DelaunayReport& report) {
  report = {};
  const Frame frame = frame_of(domain.skin);
  const auto oracle = make_oracle(scaled(domain, frame), frame.scaled(settings.element_size) / 100);
  Refinement refined = refine(*oracle, refine_settings(settings, frame));
  VolumeMesh mesh = std::move(refined.mesh);
  for (Vec3& x : mesh.nodes) x = frame.metres(x);
  mesh.region_names = domain.region_names;
  report.attempts = 1;
  report.quality = measure_quality(mesh.nodes, mesh.tetrahedra);
  report.volume_of_domain = signed_volume(domain.skin);
  report.volume_change = report.quality.volume / report.volume_of_domain - 1;
  measure_distances(domain, mesh, report);
  note(settings.log, text("Delaunay refinement: ", mesh.nodes.size(), " nodes, ",
                          mesh.tetrahedra.size(), " tetrahedra; ", summary(report.quality)));
  check(domain, mesh, settings, where, report);
  return mesh;
}

}  // namespace palpate::mesher
