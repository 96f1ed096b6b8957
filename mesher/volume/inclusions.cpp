// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/inclusions.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/quality.hpp"
#include "mesher/geometry/queries.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/skin/remesh.hpp"

namespace palpate::mesher {
namespace {

[[noreturn]] void refuse(const SurfaceFile& inclusion, const std::string& problem,
                         const std::string& remedy) {
  throw Error(ErrorKind::Geometry, inclusion.path.string(), problem, remedy);
}

/// The region of each closed cell of the filling: that of its largest element, whose centroid is
/// safely inside an inclusion or outside all of them.
std::map<std::int32_t, std::int32_t> regions_of_parts(const Filling& filling,
                                                      const std::vector<Surface>& inclusions) {
  std::map<std::int32_t, std::pair<double, std::size_t>> largest;
  for (std::size_t t = 0; t < filling.tetrahedra.size(); ++t) {
    const double v = volume(filling.nodes, filling.tetrahedra[t]);
    auto& entry = largest[filling.part[t]];
    if (v > entry.first) entry = {v, t};
  }
  const std::vector<SurfaceQuery> queries(inclusions.begin(), inclusions.end());
  std::map<std::int32_t, std::int32_t> region;
  for (const auto& [part, entry] : largest) {
    Vec3 centroid{};
    for (const std::int32_t v : filling.tetrahedra[entry.second])
      centroid = centroid + 0.25 * filling.nodes[to_index(v)];
    region[part] = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      if (queries[i].contains(centroid)) region[part] = static_cast<std::int32_t>(i) + 1;
    }
  }
  return region;
}

/// The matrix, then each layer, then each inclusion that is no void.
std::vector<std::string> region_names(const Settings& settings) {
  const auto name_or = [](const std::string& name, const std::string& fallback) {
    return name.empty() ? fallback : name;
  };
  std::vector<std::string> names{name_or(settings.surface.region_name, "matrix")};
  for (std::size_t i = 0; i < settings.layers.size(); ++i)
    names.push_back(name_or(settings.layers[i].region_name, text("layer_", i + 1)));
  for (std::size_t i = 0; i < settings.inclusions.size(); ++i) {
    if (settings.inclusions[i].is_void) continue;
    names.push_back(name_or(settings.inclusions[i].region_name, text("inclusion_", i + 1)));
  }
  return names;
}

/// Edges of the facets of an inclusion over the radius of the ball with its volume over its area,
/// and the shortest over element_size.
constexpr double kFacetOverRadius = 0.5, kShortest = 0.5;

double facet_size(const Surface& inclusion, double element_size) {
  const double radius = 3 * signed_volume(inclusion) / area(inclusion);
  return std::clamp(kFacetOverRadius * radius, kShortest * element_size, element_size);
}

constexpr double kSameVolume = 1e-9;  ///< relative

/// Moves every point outwards by the same distance, so that the surface encloses this volume:
/// chords of a curved surface enclose less. A surface with flat faces encloses it as it is.
void keep_volume(Surface& surface, double volume) {
  std::vector<Vec3> outward(surface.points.size());
  for (const Triangle& t : surface.triangles)
    for (const std::int32_t v : t)
      outward[to_index(v)] = outward[to_index(v)] + area_vector(surface.points, t);
  for (int i = 0; i < 3; ++i) {
    const double missing = volume - signed_volume(surface);
    if (std::abs(missing) < kSameVolume * volume) return;
    const double distance = missing / area(surface);
    for (std::size_t v = 0; v < outward.size(); ++v)
      surface.points[v] = surface.points[v] + distance * unit(outward[v]);
  }
}

}  // namespace

void check_inclusions(const Settings& settings, const Surface& skin,
                      const std::vector<Surface>& inclusions) {
  const SurfaceQuery inside_skin(skin);
  for (std::size_t i = 0; i < inclusions.size(); ++i) {
    const SurfaceFile& file = settings.inclusions[i];
    if (surfaces_meet(skin, inclusions[i])) {
      refuse(file, "the inclusion intersects the skin", "move or shrink it");
    }
    if (!inside_skin.contains(inclusions[i].points.front())) {
      refuse(file, "the inclusion lies outside the skin", "check its position and its unit");
    }
    const SurfaceQuery inside_this(inclusions[i]);
    for (std::size_t j = 0; j < inclusions.size(); ++j) {
      if (i == j) continue;
      const std::string other = settings.inclusions[j].path.string();
      if (surfaces_meet(inclusions[i], inclusions[j])) {
        refuse(file, "the inclusion intersects " + other, "move inclusions apart");
      }
      if (inside_this.contains(inclusions[j].points.front())) {
        refuse(file, "the inclusion contains " + other, "nested inclusions are not supported");
      }
    }
  }
}

Domain domain_of(const Settings& settings, const Surface& skin,
                 const std::vector<Surface>& inclusions) {
  Domain domain{skin, {}, {}, region_names(settings)};
  std::int32_t region = 0;
  for (const LayerSettings& layer : settings.layers)
    domain.layers.push_back({layer.thickness, ++region});
  for (std::size_t i = 0; i < inclusions.size(); ++i)
    domain.enclosures.push_back({inclusions[i], settings.inclusions[i].is_void ? kVoid : ++region});
  return domain;
}

std::vector<Surface> remesh_inclusions(const Settings& settings,
                                       const std::vector<Surface>& inclusions) {
  std::vector<Surface> remeshed;
  for (std::size_t i = 0; i < inclusions.size(); ++i) {
    const Surface& inclusion = inclusions[i];
    const double size = facet_size(inclusion, settings.element_size);
    remeshed.push_back(remesh(inclusion, {size, 1, settings.feature_angle},
                              settings.inclusions[i].path.string(), settings.log)
                           .boundary);
    keep_volume(remeshed.back(), signed_volume(inclusion));
  }
  return remeshed;
}

Surface join_shells(const Settings& settings, const Surface& boundary,
                    const std::vector<Surface>& inclusions) {
  Surface shells = boundary;
  for (std::size_t i = 0; i < inclusions.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (surfaces_meet(inclusions[i], inclusions[j])) {
        refuse(settings.inclusions[i],
               "remeshed to element_size, the inclusion intersects another one",
               "reduce element_size or move them apart");
      }
    }
    if (surfaces_meet(boundary, inclusions[i])) {
      refuse(settings.inclusions[i], "remeshed to element_size, the inclusion intersects the skin",
             "reduce element_size and patch_spacing or move it inward");
    }
    append(shells, inclusions[i]);
  }
  return shells;
}

VolumeMesh with_regions(const Settings& settings, const Filling& filling,
                        const std::vector<Surface>& inclusions) {
  VolumeMesh volume;
  volume.nodes = filling.nodes;
  volume.tetrahedra = filling.tetrahedra;
  volume.region_names = region_names(settings);
  const auto region = regions_of_parts(filling, inclusions);
  for (const std::int32_t part : filling.part) volume.region.push_back(region.at(part));
  return volume;
}

}  // namespace palpate::mesher
