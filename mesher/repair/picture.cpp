// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "format/to_index.hpp"
#include "mesher/geometry/nearest_triangle.hpp"

namespace palpate::mesher {
namespace {

/// Longer edges are divided, in cells: else the middle of a large patch would have the colour of
/// its border.
constexpr double kEdge = 3;

double longest_edge(const Surface& surface, const Triangle& t) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    longest = std::max(
        longest, norm(surface.points[to_index(t[(k + 1) % 3])] - surface.points[to_index(t[k])]));
  return longest;
}

/// Replaces a triangle by n x n small ones.
void divide(const Triangle& t, int n, Surface& surface) {
  const std::array<Vec3, 3> corner{surface.points[to_index(t[0])], surface.points[to_index(t[1])],
                                   surface.points[to_index(t[2])]};
  const auto first = static_cast<std::int32_t>(surface.points.size());
  // Row i has n + 1 - i points.
  const auto at = [&](int i, int j) { return first + i * (n + 1) - i * (i - 1) / 2 + j; };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; i + j <= n; ++j)
      surface.points.push_back((1.0 / n) *
                               ((n - i - j) * corner[0] + i * corner[1] + j * corner[2]));
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      surface.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i + j + 1 < n)
        surface.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
}

/// The surface with triangles of edges of at most this length.
Surface divided(const Surface& surface, double edge) {
  Surface result{surface.points, {}, {}, {}};
  for (const Triangle& t : surface.triangles) {
    const int n = static_cast<int>(std::ceil(longest_edge(surface, t) / edge));
    if (n > 1) {
      divide(t, n, result);
    } else {
      result.triangles.push_back(t);
    }
  }
  return result;
}

ColouredSurface coloured(const Surface& surface, const NearestTriangle& other, double cell) {
  ColouredSurface result;
  std::map<std::array<std::int64_t, 3>, std::int32_t> number;
  std::vector<std::int32_t> merged;
  for (const Vec3& x : surface.points) {
    std::array<std::int64_t, 3> key{};
    for (std::size_t k = 0; k < 3; ++k) key[k] = std::llround(x[k] / cell);
    const double distance = other.to(x).distance;
    const auto next = static_cast<std::int32_t>(result.points.size());
    const auto [entry, is_new] = number.emplace(key, next);
    if (is_new) {
      result.points.push_back(x);
      result.distance.push_back(distance);
    }
    double& largest = result.distance[to_index(entry->second)];
    largest = std::max(largest, distance);
    merged.push_back(entry->second);
  }
  for (const Triangle& t : surface.triangles) {
    const Triangle corners{merged[to_index(t[0])], merged[to_index(t[1])], merged[to_index(t[2])]};
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    result.triangles.push_back(corners);
  }
  return result;
}

}  // namespace

RepairPicture picture_of_repair(const Surface& file, const Surface& repaired, int cells) {
  const double cell = largest_dimension(file.points) / cells, edge = kEdge * cell;
  return {coloured(divided(file, edge), NearestTriangle(repaired), cell),
          coloured(divided(repaired, edge), NearestTriangle(file), cell)};
}

}  // namespace palpate::mesher
