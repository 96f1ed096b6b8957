// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

/// Triangles that need not form a surface, for queries of the nearest.
class TriangleCloud {
 public:
  TriangleCloud(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles);
  ~TriangleCloud();
  TriangleCloud(const TriangleCloud&) = delete;
  TriangleCloud& operator=(const TriangleCloud&) = delete;

  /// The nearest point of the triangles.
  /// @pre there is a triangle
  Vec3 closest(const Vec3& point) const;

  /// Fractions of the segment at which it meets triangles, ascending: exactly the triangles that it
  /// meets, each at the plane of the triangle.
  std::vector<double> hits(const Vec3& from, const Vec3& to) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace palpate::mesher
