// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/triangle_cloud.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>

#include <algorithm>
#include <iterator>

#include "format/to_index.hpp"
#include "mesher/geometry/cgal_mesh.hpp"

namespace palpate::mesher {
namespace {

using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;

Kernel::Segment_3 segment(const Vec3& from, const Vec3& to) {
  return {to_point(from), to_point(to)};
}

/// Where the segment meets the plane of the triangle, as a fraction of the segment.
double fraction_at(const Kernel::Triangle_3& triangle, const Vec3& from, const Vec3& to) {
  const Vec3 a = to_vec3(triangle[0]);
  const Vec3 normal = cross(to_vec3(triangle[1]) - a, to_vec3(triangle[2]) - a);
  const double before = dot(normal, from - a), after = dot(normal, to - a);
  if (before == after) return 0.5;  // inside the plane
  return std::clamp(before / (before - after), 0.0, 1.0);
}

}  // namespace

struct TriangleCloud::Tree {
  Triangles triangles;
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree;
};

TriangleCloud::TriangleCloud(const std::vector<Vec3>& points,
                             const std::vector<Triangle>& triangles)
    : tree_(std::make_unique<Tree>()) {
  for (const Triangle& t : triangles) {
    const auto corner = [&](std::size_t k) { return to_point(points[to_index(t[k])]); };
    tree_->triangles.emplace_back(corner(0), corner(1), corner(2));
  }
  tree_->tree.insert(tree_->triangles.cbegin(), tree_->triangles.cend());
  tree_->tree.accelerate_distance_queries();
}

TriangleCloud::~TriangleCloud() = default;

Vec3 TriangleCloud::closest(const Vec3& point) const {
  return to_vec3(tree_->tree.closest_point(to_point(point)));
}

std::vector<double> TriangleCloud::hits(const Vec3& from, const Vec3& to) const {
  std::vector<Triangles::const_iterator> met;
  tree_->tree.all_intersected_primitives(segment(from, to), std::back_inserter(met));
  std::vector<double> fractions;
  for (const auto& triangle : met) fractions.push_back(fraction_at(*triangle, from, to));
  std::sort(fractions.begin(), fractions.end());
  return fractions;
}

}  // namespace palpate::mesher
