// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/delaunay.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "format/error.hpp"
#include "mesher/volume/attempts.hpp"
#include "mesher/volume/sizing.hpp"
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

/// Thin places are refined down to this part of element_size at once.
constexpr double kSmallest = 1.0 / 4;

/// What is thinner than this part of element_size is not resolved: at acute edges refinement would
/// not end.
constexpr double kThinnest = 1.0 / 10;

SizeField surface_size(const DelaunaySettings& settings, const Frame& frame) {
  const double h = frame.scaled(settings.element_size);
  if (!settings.surface_coarsening) return [h](const Vec3&) { return h; };
  return [=, coarsening = settings.surface_coarsening](const Vec3& x) {
    return h * static_cast<float>(std::max(1.0, coarsening(frame.metres(x))));
  };
}

void to_metres(VolumeMesh& mesh, DelaunayReport& report, const Frame& frame) {
  for (Vec3& x : mesh.nodes) x = frame.metres(x);
  report.quality = measure_quality(mesh.nodes, mesh.tetrahedra);
  report.volume_of_domain *= std::pow(frame.scale, 3);
  report.distance_to_mesh *= frame.scale;
  report.distance_to_surface *= frame.scale;
  report.distance_to_mesh_at = frame.metres(report.distance_to_mesh_at);
  report.distance_to_surface_at = frame.metres(report.distance_to_surface_at);
}

VolumeMesh mesh_request(const Oracle& oracle, std::vector<SizeSource> sizes, const Frame& frame,
                        const DelaunaySettings& settings, const std::string& where,
                        DelaunayReport& report) {
  report = {};
  const double h = frame.scaled(settings.element_size);
  const double coarsest = h * static_cast<float>(settings.interior_coarsening);
  MeshRequest request{oracle,
                      std::move(sizes),
                      [=, size = surface_size(settings, frame)](const Vec3& x) {
                        return std::max(coarsest, size(x));
                      },
                      h,
                      settings.most_volume_change,
                      settings.largest_dihedral,
                      settings.most_nodes,
                      [=](const Vec3& x) { return position_text(frame.metres(x)); },
                      where,
                      settings.log};
  VolumeMesh mesh = refine_until_sound(std::move(request), report);
  to_metres(mesh, report, frame);
  note(settings.log, text("Delaunay refinement: ", mesh.nodes.size(), " nodes, ",
                          mesh.tetrahedra.size(), " tetrahedra; ", summary(report.quality)));
  return mesh;
}

bool has_region(const VolumeMesh& mesh, std::int32_t region) {
  return std::find(mesh.region.begin(), mesh.region.end(), region) != mesh.region.end();
}

/// @throws Error(Geometry) for a region without tetrahedra.
/// @param filled_by_layers whether layers may leave nothing of the first region
void check_regions(const VolumeMesh& mesh, bool filled_by_layers, const std::string& where) {
  if (!filled_by_layers && !has_region(mesh, 0)) {
    refuse_geometry(
        where,
        text("the inclusions fill the whole body: no tetrahedron belongs to the region '",
             mesh.region_names.front(), "'"),
        "check sizes and units of the inclusions, or remove one of them");
  }
  for (std::size_t region = 1; region < mesh.region_names.size(); ++region) {
    if (has_region(mesh, static_cast<std::int32_t>(region))) continue;
    refuse_geometry(where,
                    text("no tetrahedron belongs to the region '", mesh.region_names[region], "'"),
                    "check that it lies inside the skin, in the right unit and not inside a later "
                    "one, or reduce element_size");
  }
}

LabelField scaled(const LabelField& field, const Frame& frame) {
  LabelField result = field;
  result.region = [=, region = field.region](const Vec3& x) { return region(frame.metres(x)); };
  result.box = {frame.scaled(field.box.low), frame.scaled(field.box.high)};
  result.resolution = frame.scaled(field.resolution);
  return result;
}

}  // namespace

VolumeMesh mesh_domain(const Domain& domain, const DelaunaySettings& settings,
                       const std::string& where, DelaunayReport& report) {
  const Frame frame = frame_of(domain.skin);
  const Domain here = scaled(domain, frame);
  const double h = frame.scaled(settings.element_size);
  const auto oracle = make_oracle(here, kThinnest * h);
  const SizingSettings sizing{surface_size(settings, frame), kSmallest * h};
  VolumeMesh mesh =
      mesh_request(*oracle, surface_sizes(here, sizing), frame, settings, where, report);
  mesh.region_names = domain.region_names;
  check_regions(mesh, !domain.layers.empty(), where);
  return mesh;
}

VolumeMesh mesh_labels(const LabelField& field, const DelaunaySettings& settings,
                       const std::string& where, DelaunayReport& report) {
  const Vec3 span = field.box.high - field.box.low;
  const Frame frame{field.box.low, std::max({span[0], span[1], span[2]})};
  const auto oracle = make_oracle(scaled(field, frame));
  const SizeField size = surface_size(settings, frame);
  std::vector<SizeSource> sizes;
  for (const Crossing& seed : oracle->seeds([&](const Vec3& x) { return size(x) / 2; }))
    sizes.push_back({seed.point, size(seed.point)});
  if (sizes.empty()) {
    refuse_geometry(where, "no point of the image belongs to a region",
                    "check the labels that the case names");
  }
  VolumeMesh mesh = mesh_request(*oracle, std::move(sizes), frame, settings, where, report);
  mesh.region_names = field.region_names;
  return mesh;
}

}  // namespace palpate::mesher
