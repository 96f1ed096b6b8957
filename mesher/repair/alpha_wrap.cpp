// SPDX-License-Identifier: AGPL-3.0-or-later
#include <CGAL/Polygon_mesh_processing/polygon_mesh_to_polygon_soup.h>
#include <CGAL/alpha_wrap_3.h>

#include "mesher/geometry/cgal_mesh.hpp"
#include "mesher/repair/repair.hpp"

namespace palpate::mesher {

Surface alpha_wrap(const Soup& soup, double alpha, double offset) {
  std::vector<Point> points;
  for (const Vec3& x : soup.points) points.push_back(to_point(x));
  std::vector<std::array<std::size_t, 3>> triangles;
  for (const auto& corners : soup.polygons)
    for (std::size_t k = 2; k < corners.size(); ++k)
      triangles.push_back({corners[0], corners[k - 1], corners[k]});
  Mesh wrap;
  CGAL::alpha_wrap_3(points, triangles, alpha, offset, wrap);
  wrap.collect_garbage();
  return to_surface(wrap);
}

}  // namespace palpate::mesher
