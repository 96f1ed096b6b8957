// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/soundness.hpp"

#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/shape_predicates.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>

#include <algorithm>
#include <vector>

#include "mesher/geometry/cgal_mesh.hpp"

namespace palpate::mesher {
namespace pmp = CGAL::Polygon_mesh_processing;

bool is_sound(const Soup& soup) {
  std::vector<Point> points;
  for (const Vec3& x : soup.points) points.push_back(to_point(x));
  auto polygons = soup.polygons;
  if (!pmp::orient_polygon_soup(points, polygons)) return false;
  if (!pmp::is_polygon_soup_a_polygon_mesh(polygons)) return false;
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, polygons, mesh);
  if (!pmp::triangulate_faces(mesh) || !CGAL::is_closed(mesh)) return false;
  auto part = mesh.add_property_map<Mesh::Face_index, std::size_t>("f:part", 0).first;
  if (pmp::connected_components(mesh, part) != 1) return false;
  const bool degenerate = std::any_of(mesh.faces().begin(), mesh.faces().end(), [&](auto f) {
    return pmp::is_degenerate_triangle_face(f, mesh);
  });
  return !degenerate && !pmp::does_self_intersect(mesh);
}

}  // namespace palpate::mesher
