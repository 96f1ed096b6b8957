// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

/// The triangle of a surface that is nearest to a point, by a tree of boxes in double precision:
/// points on the surface, where exact predicates are slow, are the usual ones when two nearly equal
/// surfaces are compared.
class NearestTriangle {
 public:
  struct Found {
    double distance = 0;  ///< m
    std::int32_t triangle = -1;
  };

  /// @param surface at least one triangle; it need not be closed
  explicit NearestTriangle(const Surface& surface);

  Found to(const Vec3& point) const;

 private:
  struct Branch {
    Bounds box;
    std::size_t begin = 0, end = 0;  // in order_
    std::size_t children = 0;        // the first of two neighbours, or 0 for a leaf
  };
  void divide(std::size_t branch);
  void search(std::size_t branch, const Vec3& point, Found& nearest) const;
  double distance(const Vec3& point, std::size_t triangle) const;
  Vec3 middle(std::size_t triangle) const;
  Bounds box_of(std::size_t begin, std::size_t end) const;

  std::vector<Vec3> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::size_t> order_;  // triangles, those of a branch side by side
  std::vector<Branch> branches_;
};

}  // namespace palpate::mesher
