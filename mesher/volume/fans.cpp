// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/fans.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "format/to_index.hpp"
#include "mesher/geometry/quality.hpp"
#include "mesher/geometry/surface.hpp"
#include "mesher/volume/boundary.hpp"

namespace palpate::mesher {
namespace {

/// A point that cuts off less than this part of a tetrahedron lies on its side, or its corner.
constexpr double kOnCorner = 1e-9;

/// The least sine of the angles between a unit direction and the facets with these outward normals.
double least_sine(const std::vector<Vec3>& normals, const Vec3& direction) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& n : normals) least = std::min(least, dot(n, direction));
  return least;
}

}  // namespace

std::vector<std::vector<Triangle>> fans_at(const std::vector<Tetrahedron>& tetrahedra,
                                           std::int32_t node) {
  std::vector<Tetrahedron> around;
  for (const Tetrahedron& t : tetrahedra)
    if (std::find(t.begin(), t.end(), node) != t.end()) around.push_back(t);
  std::map<std::int32_t, Triangle> leaving;  // by the neighbour at which the facet begins
  for (const Triangle& t : adjacency(around).boundary) {
    const auto at = std::find(t.begin(), t.end(), node) - t.begin();
    if (at == 3) continue;
    const auto k = static_cast<std::size_t>(at);
    leaving[t[(k + 1) % 3]] = {t[k], t[(k + 1) % 3], t[(k + 2) % 3]};
  }
  std::vector<std::vector<Triangle>> fans;
  while (!leaving.empty()) {
    auto& fan = fans.emplace_back();
    for (auto next = leaving.begin(); next != leaving.end(); next = leaving.find(fan.back()[2])) {
      fan.push_back(next->second);
      leaving.erase(next);
    }
  }
  return fans;
}

OpenFan open_fan(const std::vector<Vec3>& nodes, std::vector<Triangle> facets) {
  std::vector<Vec3> normals;
  for (const Triangle& t : facets) normals.push_back(unit(area_vector(nodes, t)));
  OpenFan fan{std::move(facets), {}, -1};
  const auto consider = [&](const Vec3& towards) {
    if (!(norm(towards) > 0)) return;
    const Vec3 direction = unit(towards);
    const double least = least_sine(normals, direction);
    if (least <= fan.least_sine) return;
    fan.direction = direction;
    fan.least_sine = least;
  };
  // The best direction makes the same angle with two or three of the facets, and a larger one with
  // the others.
  for (std::size_t i = 0; i < normals.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      consider(normals[i] + normals[j]);
      for (std::size_t k = 0; k < j; ++k) {
        const Vec3 axis = cross(normals[i] - normals[k], normals[j] - normals[k]);
        consider(axis);
        consider(-axis);
      }
    }
  return fan;
}

double way_across(const std::vector<Vec3>& nodes, const std::vector<Triangle>& boundary,
                  std::int32_t node, const Vec3& direction) {
  const Vec3& origin = nodes[to_index(node)];
  double nearest = std::numeric_limits<double>::infinity();
  for (const Triangle& t : boundary) {
    if (std::find(t.begin(), t.end(), node) != t.end()) continue;
    const Vec3 a = nodes[to_index(t[0])] - origin, b = nodes[to_index(t[1])] - origin,
               c = nodes[to_index(t[2])] - origin;
    // The line lies on one side of all three edges where it crosses the facet.
    const double ab = dot(direction, cross(a, b)), bc = dot(direction, cross(b, c)),
                 ca = dot(direction, cross(c, a));
    if (std::min({ab, bc, ca}) < 0 && std::max({ab, bc, ca}) > 0) continue;
    const Vec3 normal = cross(b - a, c - a);
    const double slope = dot(normal, direction);
    if (slope == 0) continue;
    const double distance = dot(normal, a) / slope;
    if (distance > 0) nearest = std::min(nearest, distance);
  }
  return nearest;
}

bool is_inside(const std::array<Vec3, 4>& corners, const Vec3& x) {
  const std::vector<Vec3> points{corners[0], corners[1], corners[2], corners[3], x};
  constexpr std::array<Tetrahedron, 4> kParts{
      {{4, 1, 2, 3}, {0, 4, 2, 3}, {0, 1, 4, 3}, {0, 1, 2, 4}}};
  const double least = kOnCorner * volume(points, {0, 1, 2, 3});
  return std::all_of(kParts.begin(), kParts.end(),
                     [&](const Tetrahedron& part) { return volume(points, part) > least; });
}

}  // namespace palpate::mesher
