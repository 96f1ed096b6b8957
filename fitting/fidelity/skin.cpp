// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/fidelity/skin.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "format/error.hpp"

namespace palpate::fidelity {
namespace {

/// Of edges, so that no line slips through between two facets.
constexpr double kRounding = 1e-9;

/// Where the line position + s inward enters the body through a facet; NaN where it does not.
double entry(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& position,
             const Vec3& inward) {
  const Vec3 outward = cross(b - a, c - a);  // twice the area long
  const double along = dot(outward, inward);
  const double none = std::numeric_limits<double>::quiet_NaN();
  if (!(along < 0)) return none;
  const double s = dot(outward, a - position) / along;
  const Vec3 x = position + s * inward;
  const double least = -kRounding * dot(outward, outward);
  const bool inside = dot(cross(b - a, x - a), outward) >= least &&
                      dot(cross(c - b, x - b), outward) >= least &&
                      dot(cross(a - c, x - c), outward) >= least;
  return inside ? s : none;
}

}  // namespace

double skin_beside(const Body& body, const Vec3& position, const Vec3& inward) {
  double nearest = std::numeric_limits<double>::infinity();
  const auto node = [&](std::int32_t n) { return body.nodes[static_cast<std::size_t>(n)]; };
  for (const Triangle& facet : body.boundary) {
    const double s = entry(node(facet[0]), node(facet[1]), node(facet[2]), position, inward);
    if (std::abs(s) < std::abs(nearest)) nearest = s;
  }
  if (std::isinf(nearest)) {
    throw Error(ErrorKind::Geometry, "body '" + body.name + "'",
                "the skin is nowhere below a point of the response surface",
                "mesh the body again: its response surface is not that of its boundary");
  }
  return nearest;
}

std::vector<double> find_skin(const Body& body, std::vector<HeldOutPoint>& points) {
  std::vector<double> distances;
  for (HeldOutPoint& point : points) {
    if (point.node) continue;
    point.skin = skin_beside(body, point.position, point.inward);
    distances.push_back(std::abs(point.skin));
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

}  // namespace palpate::fidelity
