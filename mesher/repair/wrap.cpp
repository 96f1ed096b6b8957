// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/wrap.hpp"

#include <CGAL/alpha_wrap_3.h>

#include <array>
#include <vector>

#include "format/to_index.hpp"
#include "mesher/geometry/cgal_mesh.hpp"

namespace palpate::mesher {

Surface alpha_wrap(const Surface& surface, double alpha, double offset) {
  std::vector<Point> points;
  points.reserve(surface.points.size());
  for (const Vec3& x : surface.points) points.push_back(to_point(x));
  std::vector<std::array<std::size_t, 3>> triangles;
  for (const Triangle& t : surface.triangles)
    triangles.push_back({to_index(t[0]), to_index(t[1]), to_index(t[2])});
  Mesh wrap;
  CGAL::alpha_wrap_3(points, triangles, alpha, offset, wrap);
  wrap.collect_garbage();
  return to_surface(wrap);
}

}  // namespace palpate::mesher
