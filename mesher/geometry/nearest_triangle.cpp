// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/geometry/nearest_triangle.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "format/to_index.hpp"

namespace palpate::mesher {
namespace {

constexpr std::size_t kLeafTriangles = 4;

double distance_to(const Bounds& box, const Vec3& x) {
  Vec3 outside{};
  for (std::size_t k = 0; k < 3; ++k)
    outside[k] = std::max({box.low[k] - x[k], 0.0, x[k] - box.high[k]});
  return norm(outside);
}

}  // namespace

NearestTriangle::NearestTriangle(const Surface& surface)
    : points_(surface.points), triangles_(surface.triangles), order_(surface.triangles.size()) {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  branches_.push_back({box_of(0, order_.size()), 0, order_.size()});
  for (std::size_t branch = 0; branch < branches_.size(); ++branch) divide(branch);
}

Vec3 NearestTriangle::middle(std::size_t triangle) const {
  Vec3 sum{};
  for (const std::int32_t v : triangles_[triangle]) sum = sum + points_[to_index(v)];
  return (1.0 / 3) * sum;
}

Bounds NearestTriangle::box_of(std::size_t begin, std::size_t end) const {
  std::vector<Vec3> corners;
  for (std::size_t i = begin; i < end; ++i)
    for (const std::int32_t v : triangles_[order_[i]]) corners.push_back(points_[to_index(v)]);
  return bounds(corners);
}

/// Halves the triangles at the median of their middles along the longest side of the box.
void NearestTriangle::divide(std::size_t branch) {
  const auto [begin, end] = std::pair(branches_[branch].begin, branches_[branch].end);
  if (end - begin <= kLeafTriangles) return;
  const Vec3 span = branches_[branch].box.high - branches_[branch].box.low;
  const auto axis =
      static_cast<std::size_t>(std::max_element(span.begin(), span.end()) - span.begin());
  const std::size_t half = (begin + end) / 2;
  const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(half), at(end), [&](std::size_t a, std::size_t b) {
    return std::pair(middle(a)[axis], a) < std::pair(middle(b)[axis], b);
  });
  branches_[branch].children = branches_.size();
  branches_.push_back({box_of(begin, half), begin, half});
  branches_.push_back({box_of(half, end), half, end});
}

double NearestTriangle::distance(const Vec3& point, std::size_t triangle) const {
  const Triangle& t = triangles_[triangle];
  return distance_to_triangle(point, points_[to_index(t[0])], points_[to_index(t[1])],
                              points_[to_index(t[2])]);
}

void NearestTriangle::search(std::size_t number, const Vec3& point, Found& nearest) const {
  const Branch& branch = branches_[number];
  if (branch.children == 0) {
    for (std::size_t i = branch.begin; i < branch.end; ++i) {
      const double d = distance(point, order_[i]);
      if (d < nearest.distance) nearest = {d, static_cast<std::int32_t>(order_[i])};
    }
    return;
  }
  std::pair first(distance_to(branches_[branch.children].box, point), branch.children);
  std::pair second(distance_to(branches_[branch.children + 1].box, point), branch.children + 1);
  if (second.first < first.first) std::swap(first, second);
  if (first.first < nearest.distance) search(first.second, point, nearest);
  if (second.first < nearest.distance) search(second.second, point, nearest);
}

NearestTriangle::Found NearestTriangle::to(const Vec3& point) const {
  Found nearest{std::numeric_limits<double>::infinity(), -1};
  search(0, point, nearest);
  return nearest;
}

}  // namespace palpate::mesher
