// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/geometry/queries.hpp"
#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

/// Whether points lie inside a closed surface: by table lookup in the cells of a grid that the
/// surface does not enter, by exact predicates in the others.
class InsideGrid {
 public:
  explicit InsideGrid(const Surface& surface);
  bool contains(const Vec3& x) const;
  const SurfaceQuery& surface() const { return query_; }

  /// Bounds of the distance of a point from the surface, by that of the middle of its cell.
  struct Range {
    double low = 0, high = 0;
  };
  Range distance_range(const Vec3& x) const;

 private:
  enum class Cell : std::uint8_t { Unknown, Surface, Inside, Outside };

  void mark_surface(const Surface& surface);
  void fill_from(std::size_t seed);
  std::array<int, 3> cell_of(const Vec3& x) const;  // may lie outside the grid
  std::size_t number(const std::array<int, 3>& cell) const;
  Vec3 centre(const std::array<int, 3>& cell) const;

  SurfaceQuery query_;
  Vec3 low_{};
  double edge_ = 1;
  std::array<int, 3> count_{1, 1, 1};
  std::vector<Cell> cells_;
  mutable std::vector<double> distances_;  // of the middles of cells; negative: not yet asked for
};

}  // namespace palpate::mesher
