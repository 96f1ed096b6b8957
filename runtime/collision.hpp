// SPDX-License-Identifier: Apache-2.0
// Where the tip enters the body, and the contact point that belongs to a tip inside it.
#pragma once

#include <cstdint>
#include <vector>

#include "format/vec3.hpp"
#include "runtime/surface.hpp"

namespace palpate::runtime {

/// Axis-aligned bounding box tree over the active triangles. Immutable after construction.
class CollisionTree {
 public:
  explicit CollisionTree(const Surface& surface);  ///< the surface must outlive the tree

  /// First crossing of the segment from `from` to `to` from outside to inside. Its element is
  /// kNoElement when there is none. noexcept, allocation-free, bounded by the number of triangles;
  /// logarithmic for the short steps of a force loop.
  SurfacePoint first_entry(const Vec3& from, const Vec3& to) const noexcept;

  /// Closest point of the surface to x, no further than `within` (m); its element is kNoElement
  /// when there is none. noexcept, allocation-free, bounded by the number of triangles.
  SurfacePoint nearest(const Vec3& x, double within) const noexcept;

 private:
  struct Box {
    Vec3 low{}, high{};
  };
  struct Node {
    Box box;
    std::int32_t first = 0;  ///< leaf: first entry of order_; inner node: index of the second child
    std::int32_t count = 0;  ///< leaf: number of triangles; 0 for an inner node
  };
  struct Entry {
    double at = 2;  ///< position on the segment, 0 .. 1
    SurfacePoint point;
  };

  Box box_of(std::int32_t begin, std::int32_t end) const;
  void build(std::int32_t begin, std::int32_t end);
  void test_triangle(std::int32_t m, const Vec3& from, const Vec3& to, Entry& best) const noexcept;

  const Surface* surface_;
  std::vector<std::int32_t> order_;
  std::vector<Node> nodes_;
  double margin_ = 0;  ///< boxes are inflated by it, so that rounding never loses a triangle
};

/// Moves `from` over the surface towards the point c whose x - c is parallel to n(c), by at most
/// `passes` walks along the lateral deflection. Stops when it is below `tolerance` (m).
struct Projection {
  SurfacePoint point;
  double lateral = 0;      ///< m, what is left of it
  bool at_border = false;  ///< a border stood in the way
};
Projection project(const Surface& surface, const SurfacePoint& from, const Vec3& x, int passes,
                   double tolerance) noexcept;

}  // namespace palpate::runtime
