// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/inside_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "format/to_index.hpp"

namespace palpate::mesher {
namespace {

constexpr int kCellsAlong = 64;  // the largest dimension

}  // namespace

InsideGrid::InsideGrid(const Surface& surface) : query_(surface) {
  const Bounds box = bounds(surface.points);
  edge_ = largest_dimension(surface.points) / kCellsAlong;
  low_ = box.low - 0.5 * Vec3{edge_, edge_, edge_};
  for (std::size_t k = 0; k < 3; ++k)
    count_[k] = static_cast<int>(std::floor((box.high[k] - low_[k]) / edge_)) + 2;
  cells_.assign(to_index(count_[0]) * to_index(count_[1]) * to_index(count_[2]), Cell::Unknown);
  mark_surface(surface);
  for (std::size_t seed = 0; seed < cells_.size(); ++seed)
    if (cells_[seed] == Cell::Unknown) fill_from(seed);
}

/// Marks cells that overlap the bounds of a triangle and reach its plane.
void InsideGrid::mark_surface(const Surface& surface) {
  const double reach = 1.001 * edge_ * std::numbers::sqrt3 / 2;
  for (const Triangle& t : surface.triangles) {
    const Vec3& a = surface.points[to_index(t[0])];
    const Vec3& b = surface.points[to_index(t[1])];
    const Vec3& c = surface.points[to_index(t[2])];
    const Bounds box = bounds({a, b, c});
    const Vec3 margin = (1e-6 * edge_) * Vec3{1, 1, 1};
    const auto first = cell_of(box.low - margin), last = cell_of(box.high + margin);
    const Vec3 normal = area_vector(surface.points, t);
    const double length = norm(normal);
    for (int i = first[0]; i <= last[0]; ++i)
      for (int j = first[1]; j <= last[1]; ++j)
        for (int k = first[2]; k <= last[2]; ++k)
          if (std::abs(dot(normal, centre({i, j, k}) - a)) <= reach * length)
            cells_[number({i, j, k})] = Cell::Surface;
  }
}

/// Gives all cells connected with the seed, no surface between them, the side of its centre.
void InsideGrid::fill_from(std::size_t seed) {
  const auto rows = to_index(count_[2]), sheets = to_index(count_[1]) * rows;
  const auto place = [&](std::size_t n) {
    return std::array<int, 3>{static_cast<int>(n / sheets), static_cast<int>(n % sheets / rows),
                              static_cast<int>(n % rows)};
  };
  const Cell side = query_.contains(centre(place(seed))) ? Cell::Inside : Cell::Outside;
  std::vector<std::size_t> ahead{seed};
  cells_[seed] = side;
  while (!ahead.empty()) {
    const auto here = place(ahead.back());
    ahead.pop_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int step : {-1, 1}) {
        auto next = here;
        next[axis] += step;
        if (next[axis] < 0 || next[axis] >= count_[axis]) continue;
        const std::size_t n = number(next);
        if (cells_[n] != Cell::Unknown) continue;
        cells_[n] = side;
        ahead.push_back(n);
      }
    }
  }
}

std::array<int, 3> InsideGrid::cell_of(const Vec3& x) const {
  std::array<int, 3> cell{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double place = std::floor((x[k] - low_[k]) / edge_);
    cell[k] = static_cast<int>(std::clamp(place, -1.0, static_cast<double>(count_[k])));
  }
  return cell;
}

std::size_t InsideGrid::number(const std::array<int, 3>& cell) const {
  return (to_index(cell[0]) * to_index(count_[1]) + to_index(cell[1])) * to_index(count_[2]) +
         to_index(cell[2]);
}

Vec3 InsideGrid::centre(const std::array<int, 3>& cell) const {
  return low_ + edge_ * Vec3{cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5};
}

bool InsideGrid::contains(const Vec3& x) const {
  const auto cell = cell_of(x);
  for (std::size_t k = 0; k < 3; ++k)
    if (cell[k] < 0 || cell[k] >= count_[k]) return false;
  const Cell state = cells_[number(cell)];
  return state == Cell::Surface ? query_.contains(x) : state == Cell::Inside;
}

InsideGrid::Range InsideGrid::distance_range(const Vec3& x) const {
  const auto cell = cell_of(x);
  for (std::size_t k = 0; k < 3; ++k) {
    if (cell[k] >= 0 && cell[k] < count_[k]) continue;
    const double distance = norm(query_.closest(x).point - x);
    return {distance, distance};
  }
  if (distances_.empty()) distances_.assign(cells_.size(), -1);
  const Vec3 middle = centre(cell);
  double& distance = distances_[number(cell)];
  if (distance < 0) distance = norm(query_.closest(middle).point - middle);
  const double off = norm(x - middle);
  return {std::max(0.0, distance - off), distance + off};
}

}  // namespace palpate::mesher
