// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/sheets.hpp"

#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>

#include "mesher/geometry/cgal_mesh.hpp"

namespace palpate::mesher {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

std::vector<Point> points_of(const Soup& soup) {
  std::vector<Point> points;
  for (const Vec3& x : soup.points) points.push_back(to_point(x));
  return points;
}

}  // namespace

void remove_duplicate_faces(Soup& soup, Steps& steps) {
  std::vector<Point> points = points_of(soup);
  const std::size_t before = soup.polygons.size();
  pmp::repair_polygon_soup(points, soup.polygons);
  soup.points.clear();
  for (const Point& p : points) soup.points.push_back(to_vec3(p));
  if (soup.polygons.size() < before)
    steps.push_back("removed " +
                    counted(before - soup.polygons.size(), "duplicate or collapsed face"));
}

Sheets connect(const Soup& soup, Steps& steps) {
  std::vector<Point> points = points_of(soup);
  std::vector<std::vector<std::size_t>> polygons = soup.polygons;
  pmp::orient_polygon_soup(points, polygons);
  const std::size_t duplicated = points.size() - soup.points.size();
  if (duplicated > 0)
    steps.push_back(text("separated sheets that met in an edge or a point: ",
                         counted(duplicated, "point"), " duplicated"));
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, polygons, mesh);
  pmp::triangulate_faces(mesh);
  if (const std::size_t stitched = pmp::stitch_borders(mesh); stitched > 0)
    steps.push_back("stitched " + counted(stitched, "pair") + " of border edges");
  mesh.collect_garbage();
  return {to_surface(mesh), duplicated > 0};
}

}  // namespace palpate::mesher
