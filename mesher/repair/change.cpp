// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/change.hpp"

#include "format/to_index.hpp"
#include "mesher/geometry/nearest_triangle.hpp"

namespace palpate::mesher {
namespace {

Vec3 middle(const Surface& surface, const Triangle& t) {
  Vec3 sum{};
  for (const auto v : t) sum = sum + surface.points[to_index(v)];
  return (1.0 / 3) * sum;
}

}  // namespace

Change change_between(const Surface& from, const Surface& to, double far) {
  const NearestTriangle nearest(to);
  Change change;
  const auto look = [&](const Vec3& x) {
    const double distance = nearest.to(x).distance;
    if (distance > change.distance) {
      change.distance = distance;
      change.at = x;
    }
    return distance;
  };
  for (const Triangle& t : from.triangles) {
    const double area = norm(area_vector(from.points, t)) / 2;
    change.area += area;
    if (look(middle(from, t)) <= far) continue;
    change.far_area += area;
    change.far_faces.add(from, t, Fault::Moved);
  }
  for (const Vec3& x : from.points) look(x);
  return change;
}

void hand_on_names(Surface& surface, const Surface& before,
                   const std::vector<std::size_t>& names_of) {
  const NearestTriangle nearest(before);
  for (const Triangle& t : surface.triangles)
    surface.names.push_back(names_of[to_index(nearest.to(middle(surface, t)).triangle)]);
}

}  // namespace palpate::mesher
