// SPDX-License-Identifier: Apache-2.0
// Where the tip enters the body, and the contact point that belongs to a tip inside it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/vec3.hpp"
#include "runtime/delivery.hpp"
#include "runtime/surface.hpp"

namespace palpate::runtime {

/// First crossing of the segment from `from` to `to` from outside to inside, among some triangles;
/// its element is kNoElement when there is none. noexcept, allocation-free, linear.
SurfacePoint first_entry(const Surface& surface, std::span<const std::int32_t> elements,
                         const Vec3& from, const Vec3& to) noexcept;

/// Closest point to x on some triangles, no farther than `within` (m). noexcept, allocation-free,
/// linear.
SurfacePoint nearest(const Surface& surface, std::span<const std::int32_t> elements, const Vec3& x,
                     double within) noexcept;

/// Axis-aligned bounding box tree over the active triangles. Immutable after construction.
class CollisionTree {
 public:
  explicit CollisionTree(const Surface& surface);  ///< the surface must outlive the tree

  /// First crossing of the segment from `from` to `to` from outside to inside. Its element is
  /// kNoElement when there is none. noexcept, allocation-free, bounded by the number of triangles;
  /// logarithmic for the short steps of a force loop.
  SurfacePoint first_entry(const Vec3& from, const Vec3& to) const noexcept;

  /// Closest point of the surface to x, no farther than `within` (m); its element is kNoElement
  /// when there is none. noexcept, allocation-free, bounded by the number of triangles.
  SurfacePoint nearest(const Vec3& x, double within) const noexcept;

  /// Appends the triangles whose boxes come within `radius` (m) of the segment, at most `most`.
  void gather(const Vec3& from, const Vec3& to, double radius, std::size_t most,
              std::vector<std::int32_t>& elements) const;

 private:
  struct Box {
    Vec3 low{}, high{};
  };
  struct Node {
    Box box;
    std::int32_t first = 0;  ///< leaf: first entry of order_; inner node: index of the second child
    std::int32_t count = 0;  ///< leaf: number of triangles; 0 for an inner node
  };
  Box box_of(std::int32_t begin, std::int32_t end) const;
  void build(std::int32_t begin, std::int32_t end);

  const Surface* surface_;
  std::vector<std::int32_t> order_;
  std::vector<Node> nodes_;
  double margin_ = 0;  ///< boxes are inflated by it, so that rounding never loses a triangle
};

/// Moves `from` over the surface towards the point c whose x - c is parallel to n(c), by at most
/// `passes` walks along the lateral deflection. Stops when it is below `tolerance` (m).
struct Projection {
  SurfacePoint point;
  double lateral = 0;      ///< m, remaining lateral deflection
  bool at_border = false;  ///< a border stopped it
  bool awaiting = false;   ///< a triangle that is not delivered stopped it
};
Projection project(const Surface& surface, const SurfacePoint& from, const Vec3& x, int passes,
                   double tolerance, const Delivery* delivered = nullptr) noexcept;

}  // namespace palpate::runtime
