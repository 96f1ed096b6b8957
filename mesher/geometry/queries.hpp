// SPDX-License-Identifier: AGPL-3.0-or-later
// Queries of closed surfaces by exact predicates.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

using TrianglePair = std::pair<std::int32_t, std::int32_t>;

/// Pairs of triangles that meet elsewhere than in their common vertex or edge.
std::vector<TrianglePair> self_intersections(const Surface& surface);

/// Their number.
std::size_t count_self_intersections(const Surface& surface);

/// Triangles whose corners lie exactly on one line.
std::vector<std::int32_t> degenerate_triangles(const Surface& surface);

/// Their number.
std::size_t count_degenerate_triangles(const Surface& surface);

/// Whether the two surfaces touch or cross.
bool surfaces_meet(const Surface& a, const Surface& b);

/// A search tree over a copy of a closed surface that is oriented outward.
class SurfaceQuery {
 public:
  struct Foot {
    Vec3 point{};
    std::int32_t triangle = -1;
  };

  explicit SurfaceQuery(const Surface& surface);
  ~SurfaceQuery();
  SurfaceQuery(SurfaceQuery&&) noexcept;
  SurfaceQuery& operator=(SurfaceQuery&&) noexcept;

  /// Whether the point is strictly inside.
  bool contains(const Vec3& point) const;

  /// The nearest point of the surface.
  Foot closest(const Vec3& point) const;

  /// Distance from `origin` along the unit `direction` to the first triangle hit, without the
  /// triangles around the vertex `skip` (-1 skips none).
  std::optional<double> first_hit(const Vec3& origin, const Vec3& direction,
                                  std::int32_t skip = -1) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace palpate::mesher
