// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/init/first_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/case/lengths.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/queries.hpp"

namespace palpate::app {
namespace {

using mesher::Surface;

constexpr double kFewestPatches = 6;  // along the extent
constexpr double kFinestForThickness = 2;
constexpr double kDepthOfThickness = 0.3, kDepthOfThinParts = 0.6;

struct Face {
  Vec3 middle{};
  Vec3 area_vector{};
};

std::vector<Face> faces_off(const Base& base, const Surface& surface) {
  std::vector<Face> faces;
  for (const Triangle& t : surface.triangles) {
    const Vec3 middle =
        (1.0 / 3) * (surface.points[to_index(t[0])] + surface.points[to_index(t[1])] +
                     surface.points[to_index(t[2])]);
    const Vec3 area = mesher::area_vector(surface.points, t);
    if (!base.holds(middle) && norm(area) > 0) faces.push_back({middle, area});
  }
  return faces;
}

using Inward = std::function<Vec3(const Vec3&)>;

/// The unit vector into the body at a face: across it, where nothing else tells.
Vec3 inward_at(const Face& face, const Inward& inward) {
  const Vec3 across = -mesher::unit(face.area_vector);
  if (!inward) return across;
  const Vec3 direction = inward(face.middle);
  return dot(direction, across) > 0 ? direction : across;
}

/// Thicknesses below points that are spread over the area, ascending.
std::vector<double> thicknesses(const Surface& surface, const std::vector<Face>& faces, double area,
                                const Inward& inward_of) {
  constexpr int samples = 400;
  const mesher::SurfaceQuery query(surface);
  const double skin = 1e-6 * mesher::largest_dimension(surface.points);
  std::vector<double> found;
  double passed = 0;
  for (const Face& face : faces) {
    const double before = std::floor(passed * samples / area);
    passed += norm(face.area_vector) / 2;
    if (std::floor(passed * samples / area) == before) continue;
    const Vec3 inward = inward_at(face, inward_of);
    if (const auto hit = query.first_hit(face.middle + skin * inward, inward))
      found.push_back(*hit);
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

double two_digits(double value) {
  const double step = std::pow(10, std::floor(std::log10(value)) - 1);
  return step * std::round(value / step);
}

FirstSizes first_sizes(const Surface& surface, const Base& base, int sites, const Inward& inward) {
  const std::vector<Face> faces = faces_off(base, surface);
  FirstSizes sizes;
  for (const Face& face : faces) sizes.pressable_area += norm(face.area_vector) / 2;
  const std::vector<double> below = thicknesses(surface, faces, sizes.pressable_area, inward);
  const double extent = mesher::largest_dimension(surface.points);
  sizes.thickness = below.empty() ? extent : below[below.size() / 2];
  sizes.thin_parts = below.empty() ? extent : below[below.size() / 20];

  const double even = std::sqrt(sizes.pressable_area / (kAreaOfVertex * sites));
  const double coarsest = extent / kFewestPatches;
  const double spread = faces.empty() ? coarsest : std::min(even, coarsest);
  sizes.is_coarsest = spread < even;
  sizes.is_thin = sizes.thickness < spread;
  sizes.patch_spacing =
      two_digits(std::max(std::min(spread, sizes.thickness), spread / kFinestForThickness));
  sizes.element_size = two_digits(kElementOverPatch * sizes.patch_spacing);
  sizes.tool_radius = two_digits(kRadiusOverPatch * sizes.patch_spacing);
  const double deep =
      std::min({kDepthOverPatch * sizes.patch_spacing, kDepthOfThickness * sizes.thickness,
                kDepthOfThinParts * sizes.thin_parts});
  sizes.depth = two_digits(std::max(deep, kShallowestOverPatch * sizes.patch_spacing));
  sizes.lateral_travel = two_digits(kTravelOverDepth * sizes.depth);
  return sizes;
}

}  // namespace palpate::app
