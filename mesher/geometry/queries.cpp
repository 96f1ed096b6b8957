// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/geometry/queries.hpp"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Polygon_mesh_processing/intersection.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Side_of_triangle_mesh.h>

#include <iterator>
#include <utility>

#include "format/to_index.hpp"
#include "mesher/geometry/cgal_mesh.hpp"

namespace palpate::mesher {
namespace pmp = CGAL::Polygon_mesh_processing;

std::vector<TrianglePair> self_intersections(const Surface& surface) {
  const Mesh mesh = to_mesh(surface);
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
  pmp::self_intersections(mesh, std::back_inserter(pairs));
  std::vector<TrianglePair> result;
  for (const auto& [a, b] : pairs)
    result.emplace_back(static_cast<std::int32_t>(a.idx()), static_cast<std::int32_t>(b.idx()));
  return result;
}

std::size_t count_self_intersections(const Surface& surface) {
  return self_intersections(surface).size();
}

std::vector<std::int32_t> degenerate_triangles(const Surface& surface) {
  std::vector<std::int32_t> result;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const Triangle& t = surface.triangles[i];
    const auto corner = [&](std::size_t k) { return to_point(surface.points[to_index(t[k])]); };
    if (CGAL::collinear(corner(0), corner(1), corner(2)))
      result.push_back(static_cast<std::int32_t>(i));
  }
  return result;
}

std::size_t count_degenerate_triangles(const Surface& surface) {
  return degenerate_triangles(surface).size();
}

bool surfaces_meet(const Surface& a, const Surface& b) {
  return pmp::do_intersect(to_mesh(a), to_mesh(b));
}

struct SurfaceQuery::Tree {
  using Primitive = CGAL::AABB_face_graph_triangle_primitive<Mesh>;
  using Faces = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

  explicit Tree(const Surface& surface)
      : triangles(surface.triangles),
        mesh(to_mesh(surface)),
        faces(mesh.faces().begin(), mesh.faces().end(), mesh),
        side(faces) {
    faces.accelerate_distance_queries();
  }

  bool touches(Mesh::Face_index face, std::int32_t vertex) const {
    const Triangle& t = triangles[face.idx()];
    return t[0] == vertex || t[1] == vertex || t[2] == vertex;
  }

  std::vector<Triangle> triangles;
  Mesh mesh;
  Faces faces;
  CGAL::Side_of_triangle_mesh<Mesh, Kernel> side;
};

SurfaceQuery::SurfaceQuery(const Surface& surface) : tree_(std::make_unique<Tree>(surface)) {}
SurfaceQuery::~SurfaceQuery() = default;
SurfaceQuery::SurfaceQuery(SurfaceQuery&&) noexcept = default;
SurfaceQuery& SurfaceQuery::operator=(SurfaceQuery&&) noexcept = default;

bool SurfaceQuery::contains(const Vec3& point) const {
  return tree_->side(to_point(point)) == CGAL::ON_BOUNDED_SIDE;
}

SurfaceQuery::Foot SurfaceQuery::closest(const Vec3& point) const {
  const auto [foot, face] = tree_->faces.closest_point_and_primitive(to_point(point));
  return {to_vec3(foot), static_cast<std::int32_t>(face.idx())};
}

std::optional<double> SurfaceQuery::first_hit(const Vec3& origin, const Vec3& direction,
                                              std::int32_t skip) const {
  const Kernel::Ray_3 ray(to_point(origin),
                          Kernel::Vector_3(direction[0], direction[1], direction[2]));
  const auto hit = tree_->faces.first_intersection(
      ray, [&](Mesh::Face_index face) { return skip >= 0 && tree_->touches(face, skip); });
  if (!hit) return std::nullopt;
  if (const auto* point = boost::get<Point>(&hit->first)) {
    return dot(to_vec3(*point) - origin, direction);
  }
  // The ray runs inside a triangle: the nearer end of the common segment counts.
  const auto& segment = boost::get<Kernel::Segment_3>(hit->first);
  return std::min(dot(to_vec3(segment.source()) - origin, direction),
                  dot(to_vec3(segment.target()) - origin, direction));
}

}  // namespace palpate::mesher
