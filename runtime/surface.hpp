// SPDX-License-Identifier: Apache-2.0
// The response surface made ready for the force loop: triangles, who is next to whom, responses.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "format/library.hpp"
#include "format/vec3.hpp"
#include "runtime/interpolated_response.hpp"
#include "runtime/lanes.hpp"
#include "runtime/large_memory.hpp"
#include "runtime/soft_axes.hpp"

namespace palpate::runtime {

inline constexpr std::int32_t kNoElement = -1;

/// A triangle of the response surface.
struct alignas(kCacheLine) Element {
  std::array<std::int32_t, 3> vertices{};  ///< their records in the memory of the surface
  /// neighbour[l] is across the edge opposite to vertex l; kNoElement at a border.
  std::array<std::int32_t, 3> neighbour{kNoElement, kNoElement, kNoElement};
  std::array<Vec3, 3> gradient{};  ///< of the natural coordinates, 1/m, in the plane
  Vec3 facet_normal{};             ///< unit, INTO the body
  bool active = false;  ///< false next to a hole: cannot be touched, a border for its neighbours
};

/// The data of a vertex: one cache line, followed by those of its curves. An element refers to it
/// by the number of that line, so that a step can prefetch it without reading it.
struct alignas(kCacheLine) SurfaceNode {
  Vec3 position{};  ///< m
  Vec3 inward{};    ///< unit
  NodeCurves curves;
};
static_assert(sizeof(SurfaceNode) == kCacheLine);

/// g_i of a vertex of a library that relaxes: the cache line after its data.
struct alignas(kCacheLine) NodeRelaxation {
  Pair fractions[pairs_of(kMaxRelaxationTimes)]{};
};
static_assert(sizeof(NodeRelaxation) == kCacheLine);

/// The lean and the soft axis of a vertex of a library that has any: the cache line before its
/// curves.
struct alignas(kCacheLine) NodeAxes {
  Vec3 lean{};       ///< sigma, 1
  Vec3 soft_axis{};  ///< b, 1
};
static_assert(sizeof(NodeAxes) == kCacheLine);

/// A point of the surface: an element and natural coordinates n_l >= 0 that sum to 1.
struct SurfacePoint {
  std::int32_t element = kNoElement;
  Vec3 natural{};

  bool operator==(const SurfacePoint& other) const noexcept {
    return element == other.element && natural[0] == other.natural[0] &&
           natural[1] == other.natural[1] && natural[2] == other.natural[2];
  }
};

/// Immutable after construction; shared by any number of threads.
class Surface {
 public:
  /// @throws Error(Configuration) when an edge belongs to more than two triangles or to two of
  /// opposite
  ///   orientation, Error(Geometry) when a triangle has no area, |sum n_l u_l| < 0.5 somewhere in
  ///   it (the direction cannot be interpolated), or a direction does not point to its inner side.
  explicit Surface(const Library& library);

  const Element& element(std::int32_t m) const noexcept {
    return elements_[static_cast<std::size_t>(m)];
  }
  std::int32_t element_count() const noexcept {
    return static_cast<std::int32_t>(elements_.size());
  }
  const Vec3& vertex(const Element& e, std::size_t l) const noexcept { return node(e, l).position; }
  const Vec3& inward(const Element& e, std::size_t l) const noexcept { return node(e, l).inward; }

  Vec3 position(const SurfacePoint& p) const noexcept {
    const Element& e = element(p.element);
    return p.natural[0] * vertex(e, 0) + p.natural[1] * vertex(e, 1) + p.natural[2] * vertex(e, 2);
  }
  /// sum n_l u_l, not normalised [Mahvash & Hayward 2005, eq. 26].
  Vec3 direction_sum(const SurfacePoint& p) const noexcept {
    const Element& e = element(p.element);
    return p.natural[0] * inward(e, 0) + p.natural[1] * inward(e, 1) + p.natural[2] * inward(e, 2);
  }
  /// n, the unit press direction at p. Always normalised: the energy (32) needs |n| = 1.
  Vec3 normal(const SurfacePoint& p) const noexcept {
    const Vec3 sum = direction_sum(p);
    return (1.0 / norm(sum)) * sum;
  }
  InterpolatedResponse response(const SurfacePoint& p) const noexcept {
    const Element& e = element(p.element);
    return {{&node(e, 0).curves, &node(e, 1).curves, &node(e, 2).curves}, p.natural};
  }

  /// Prefetch the surroundings of an element, in two calls that should be a step apart: first the
  /// elements beyond its neighbours and the vertices opposite to its edges, then the vertices of
  /// the elements beyond. The contact point can then cross an edge, or near a vertex two, without
  /// waiting for memory. Of the curves only the lines in use at the contact point are prefetched.
  void prefetch_around(std::int32_t m, const NodeCurves::InUse& in_use) const noexcept;
  void prefetch_beyond(std::int32_t m, const NodeCurves::InUse& in_use) const noexcept;

  /// Signed distance of x to the plane of an element, positive OUTSIDE the body, m. Collision and
  /// release use this one expression, so that they agree on which side a point is.
  double outside_distance(const Element& e, const Vec3& x) const noexcept {
    return dot(vertex(e, 0) - x, e.facet_normal);
  }

  const Vec3& low() const noexcept { return low_; }
  const Vec3& high() const noexcept { return high_; }
  double diagonal() const noexcept { return norm(high_ - low_); }  ///< of the bounding box, m
  double deepest() const noexcept { return deepest_; }  ///< deepest sample of any node, m

  /// tau_i, s; empty: the responses are elastic.
  const std::vector<double>& relaxation_times() const noexcept { return relaxation_times_; }
  /// Whether all nodes have the same fractions.
  bool relaxes_alike() const noexcept { return relaxes_alike_; }
  double tool_radius() const noexcept { return tool_radius_; }                  ///< m
  double inverse_tool_radius() const noexcept { return inverse_tool_radius_; }  ///< 1/m, 0: none
  bool leans() const noexcept { return leans_; }  ///< whether a node does
  /// sum W_l sigma_l in an element, 1, across the normal n.
  Vec3 lean(const Element& e, const Vec3& weights, const Vec3& n) const noexcept {
    const Vec3 sum = weights[0] * lean(e, 0) + weights[1] * lean(e, 1) + weights[2] * lean(e, 2);
    return sum - dot(sum, n) * n;
  }
  /// sigma of a vertex; zero where no node leans.
  Vec3 lean(const Element& e, std::size_t l) const noexcept {
    return leans_ ? axes(e, l).lean : Vec3{};
  }
  bool has_soft_axes() const noexcept { return has_soft_axes_; }  ///< whether a node has one
  /// b of a vertex; zero where no node has one.
  Vec3 soft_axis(const Element& e, std::size_t l) const noexcept {
    return has_soft_axes_ ? axes(e, l).soft_axis : Vec3{};
  }
  /// S at a point with the normal n. @pre has_soft_axes()
  SoftAxes soft_axes(const SurfacePoint& p, const Vec3& n) const noexcept {
    const Element& e = element(p.element);
    SoftAxes sum;
    for (std::size_t l = 0; l < 3; ++l) {
      const Vec3& b = axes(e, l).soft_axis;
      sum.add(p.natural[l], b - dot(b, n) * n);
    }
    sum.finish();
    return sum;
  }
  /// g_i at a point, interpolated; zero beyond the relaxation times. @pre they are not empty
  Lanes fractions(const SurfacePoint& p) const noexcept;

 private:
  std::vector<std::int32_t> build_nodes(const Library& library);
  void build_node(const Library& library, std::size_t v, CacheLine* memory);
  void build_element(const Library& library, const std::vector<std::int32_t>& record,
                     std::size_t m);
  void connect();
  void check_directions(const Library& library, std::size_t m) const;

  void prefetch_opposite(const Element& e, std::size_t l,
                         const NodeCurves::InUse& in_use) const noexcept;
  const SurfaceNode& node(const Element& e, std::size_t l) const noexcept {
    return *reinterpret_cast<const SurfaceNode*>(
        &records_[static_cast<std::size_t>(e.vertices[l])]);
  }
  const NodeAxes& axes(const Element& e, std::size_t l) const noexcept {
    const auto record = static_cast<std::size_t>(e.vertices[l]) + curves_at_ - 1;
    return *reinterpret_cast<const NodeAxes*>(&records_[record]);
  }
  bool has_axes() const noexcept { return leans_ || has_soft_axes_; }

  template <class T>
  using Table = std::vector<T, LargeMemory<T>>;
  Table<CacheLine> records_;  ///< a SurfaceNode and its curves for each node
  Table<Element> elements_;
  Vec3 low_{}, high_{};
  double deepest_ = 0;
  std::vector<double> relaxation_times_;
  bool relaxes_alike_ = true;
  double tool_radius_ = 0, inverse_tool_radius_ = 0;
  bool leans_ = false, has_soft_axes_ = false;
  std::size_t curves_at_ = 1;  ///< line of the curves of a node, counted from its first
};

}  // namespace palpate::runtime
