// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/wrap.hpp"

#include <CGAL/alpha_wrap_3.h>

#include <array>
#include <vector>

#include "format/to_index.hpp"
#include "mesher/geometry/cgal_mesh.hpp"

namespace palpate::mesher {
namespace {

using Corners = std::array<std::size_t, 3>;

Surface wrap_of(const std::vector<Vec3>& vertices, const std::vector<Corners>& triangles,
                double alpha, double offset) {
  std::vector<Point> points;
  points.reserve(vertices.size());
  for (const Vec3& x : vertices) points.push_back(to_point(x));
  Mesh wrap;
  CGAL::alpha_wrap_3(points, triangles, alpha, offset, wrap);
  wrap.collect_garbage();
  return to_surface(wrap);
}

}  // namespace

Surface alpha_wrap(const Soup& soup, double alpha, double offset) {
  std::vector<Corners> triangles;
  for (const auto& corners : soup.polygons)
    for (std::size_t k = 2; k < corners.size(); ++k)
      triangles.push_back({corners[0], corners[k - 1], corners[k]});
  return wrap_of(soup.points, triangles, alpha, offset);
}

Surface alpha_wrap(const Surface& surface, double alpha, double offset) {
  std::vector<Corners> triangles;
  for (const Triangle& t : surface.triangles)
    triangles.push_back({to_index(t[0]), to_index(t[1]), to_index(t[2])});
  return wrap_of(surface.points, triangles, alpha, offset);
}

double mean_thickness(const Surface& surface) {
  const double sides = area(surface);
  return sides > 0 ? 2 * signed_volume(surface) / sides : 0;
}

}  // namespace palpate::mesher
