// SPDX-License-Identifier: AGPL-3.0-or-later
// Conversions between Surface and CGAL meshes. Only the .cpp files that use CGAL include this.
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

inline Point to_point(const Vec3& x) {
  return {x[0], x[1], x[2]};
}
inline Vec3 to_vec3(const Point& p) {
  return {p.x(), p.y(), p.z()};
}

/// Vertex and face indices of the mesh are those of the surface.
inline Mesh to_mesh(const Surface& surface) {
  Mesh mesh;
  for (const Vec3& x : surface.points) mesh.add_vertex(to_point(x));
  const auto vertex = [](std::int32_t v) { return Mesh::Vertex_index(static_cast<unsigned>(v)); };
  for (const Triangle& t : surface.triangles) {
    mesh.add_face(vertex(t[0]), vertex(t[1]), vertex(t[2]));
  }
  return mesh;
}

/// @pre no removed elements (collect_garbage() was called).
inline Surface to_surface(const Mesh& mesh) {
  Surface surface;
  surface.points.reserve(mesh.number_of_vertices());
  surface.triangles.reserve(mesh.number_of_faces());
  for (const auto v : mesh.vertices()) surface.points.push_back(to_vec3(mesh.point(v)));
  for (const auto f : mesh.faces()) {
    Triangle t{};
    std::size_t k = 0;
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f))) {
      t[k++] = static_cast<std::int32_t>(v.idx());
    }
    surface.triangles.push_back(t);
  }
  return surface;
}

}  // namespace palpate::mesher
