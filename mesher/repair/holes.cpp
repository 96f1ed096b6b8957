// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/holes.hpp"

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "mesher/geometry/cgal_mesh.hpp"

namespace palpate::mesher {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

// A hole whose border leaves its mean plane by less than this fraction of its diameter is a flat
// cut.
constexpr double kFlatHole = 0.03;
// The search through all triangulations of a border takes its length to the third power.
constexpr std::size_t kLongestForSearch = 300;

std::vector<Vec3> border_of(const Mesh& mesh, Mesh::Halfedge_index border) {
  std::vector<Vec3> points;
  for (const auto h : CGAL::halfedges_around_face(border, mesh))
    points.push_back(to_vec3(mesh.point(mesh.target(h))));
  return points;
}

Hole hole_of(const std::vector<Vec3>& points) {
  const Bounds box = bounds(points);
  Hole hole;
  hole.diameter = norm(box.high - box.low);
  for (const Vec3& x : points) hole.centre = hole.centre + x;
  hole.centre = (1.0 / static_cast<double>(points.size())) * hole.centre;
  Vec3 normal{};
  for (std::size_t k = 0; k < points.size(); ++k)
    normal = normal + cross(points[k] - hole.centre, points[(k + 1) % points.size()] - hole.centre);
  if (norm(normal) == 0) return hole;
  normal = unit(normal);
  for (const Vec3& x : points)
    hole.flatness = std::max(hole.flatness, std::abs(dot(x - hole.centre, normal)));
  return hole;
}

/// Triangles from the border to one point.
void fill_with_cone(Mesh& mesh, Mesh::Halfedge_index border, const Vec3& tip,
                    std::vector<Mesh::Face_index>& faces) {
  const std::vector<Mesh::Halfedge_index> edges(CGAL::halfedges_around_face(border, mesh).begin(),
                                                CGAL::halfedges_around_face(border, mesh).end());
  const auto centre = mesh.add_vertex(to_point(tip));
  for (const auto h : edges) {
    const auto face = mesh.add_face(mesh.source(h), mesh.target(h), centre);
    if (face != Mesh::null_face()) faces.push_back(face);
  }
}

Hole fill_hole(Mesh& mesh, Mesh::Halfedge_index border) {
  const std::vector<Vec3> points = border_of(mesh, border);
  Hole hole = hole_of(points);
  std::vector<Mesh::Face_index> faces;
  std::vector<Mesh::Vertex_index> vertices;
  pmp::triangulate_and_refine_hole(
      mesh, border, std::back_inserter(faces), std::back_inserter(vertices),
      pmp::parameters::do_not_use_cubic_algorithm(points.size() > kLongestForSearch));
  if (faces.empty()) {
    hole.is_cone = true;
    fill_with_cone(mesh, border, hole.centre, faces);
  }
  for (const auto f : faces) hole.area += CGAL::to_double(pmp::face_area(f, mesh));
  return hole;
}

}  // namespace

bool Hole::is_flat() const {
  return flatness <= kFlatHole * diameter;
}

std::vector<Hole> fill_holes(Surface& surface) {
  Mesh mesh = to_mesh(surface);
  std::vector<Mesh::Halfedge_index> borders;
  pmp::extract_boundary_cycles(mesh, std::back_inserter(borders));
  std::vector<Hole> holes;
  for (const auto border : borders) holes.push_back(fill_hole(mesh, border));
  if (!holes.empty()) surface = to_surface(mesh);
  return holes;
}

}  // namespace palpate::mesher
