// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/geometry/thickness.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "format/tangent_frame.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/queries.hpp"

namespace palpate::mesher {
namespace {

constexpr int kRing = 6;
constexpr double kFacesTool = 0.3;  // least cosine of the surface normal with the line of the tool
constexpr double kSmooth = 0.8;     // the same, of all facets around a vertex that is no edge

double largest_on_ring(const Surface& boundary, const SurfaceQuery& query, const Vec3& centre,
                       const Vec3& inward, double radius) {
  const auto [e1, e2] = tangent_frame(inward);
  double largest = 0;
  for (int k = 0; k < kRing; ++k) {
    const double angle = 2 * std::numbers::pi * k / kRing;
    const Vec3 around = centre + radius * (std::cos(angle) * e1 + std::sin(angle) * e2);
    const auto foot = query.closest(around);
    const Vec3 outward =
        unit(area_vector(boundary.points, boundary.triangles[to_index(foot.triangle)]));
    if (-dot(outward, inward) < kFacesTool) continue;
    // A step below the surface, so that the first triangle hit is the far side.
    const double step = 1e-3 * radius;
    if (const auto hit = query.first_hit(foot.point + step * inward, inward)) {
      largest = std::max(largest, *hit + step);
    }
  }
  return largest;
}

/// Smallest cosine between the press direction and the inward normals of the facets at a vertex.
std::vector<double> least_cosines(const Surface& boundary, const std::vector<Vec3>& inward) {
  std::vector<double> least(inward.size(), 1);
  for (const Triangle& t : boundary.triangles) {
    const Vec3 outward = unit(area_vector(boundary.points, t));
    for (const std::int32_t corner : t) {
      const auto v = to_index(corner);
      if (v < inward.size()) least[v] = std::min(least[v], -dot(outward, inward[v]));
    }
  }
  return least;
}

}  // namespace

std::vector<double> thickness_under_tool(const Surface& boundary, const std::vector<Vec3>& inward,
                                         double tool_radius) {
  const SurfaceQuery query(boundary);
  const std::vector<double> cosine = least_cosines(boundary, inward);
  std::vector<double> thickness(inward.size());
  for (std::size_t v = 0; v < inward.size(); ++v) {
    const Vec3& site = boundary.points[v];
    thickness[v] = query.first_hit(site, inward[v], static_cast<std::int32_t>(v)).value_or(0);
    if (cosine[v] >= kSmooth) continue;
    thickness[v] =
        std::max(thickness[v], largest_on_ring(boundary, query, site, inward[v], tool_radius));
  }
  return thickness;
}

}  // namespace palpate::mesher
