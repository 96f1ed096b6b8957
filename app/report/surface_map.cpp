// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/surface_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "app/report/figures.hpp"
#include "format/to_index.hpp"

namespace palpate::report {

namespace {

NearestPoint nearest_on_edge(const Vec3& p, const std::array<Vec3, 3>& corner, std::size_t i) {
  const std::size_t j = (i + 1) % 3;
  const Vec3 edge = corner[j] - corner[i];
  const double length2 = dot(edge, edge);
  const double t = length2 > 0 ? std::clamp(dot(p - corner[i], edge) / length2, 0.0, 1.0) : 0.0;
  NearestPoint result;
  result.natural[i] = 1 - t;
  result.natural[j] = t;
  const Vec3 gap = p - (corner[i] + t * edge);
  result.distance2 = dot(gap, gap);
  return result;
}

/// Uniform grid over the bounding boxes of the response triangles.
class TriangleGrid {
 public:
  TriangleGrid(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles)
      : points_(points), triangles_(triangles) {
    low_ = high_ = points_.empty() ? Vec3{} : points_[0];
    for (const Vec3& p : points_) {
      for (std::size_t k = 0; k < 3; ++k) {
        low_[k] = std::min(low_[k], p[k]);
        high_[k] = std::max(high_[k], p[k]);
      }
    }
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, high_[k] - low_[k]);
    // About a patch wide, but never more than 64 cells a side.
    cell_ = std::max({median_edge(points_, triangles_), longest / 64, 1e-12});
    for (std::size_t k = 0; k < 3; ++k)
      count_[k] = 1 + static_cast<std::int32_t>((high_[k] - low_[k]) / cell_);
    bins_.resize(to_index(count_[0]) * to_index(count_[1]) * to_index(count_[2]));
    for (std::size_t m = 0; m < triangles_.size(); ++m) insert(static_cast<std::int32_t>(m));
  }

  std::pair<std::int32_t, NearestPoint> nearest(const Vec3& p) const { return search(p, nullptr); }
  /// Nearest triangle whose normal has a positive component along `normal`; when there is none,
  /// the nearest of all.
  std::pair<std::int32_t, NearestPoint> nearest(const Vec3& p, const Vec3& normal) const {
    auto found = search(p, &normal);
    return found.first >= 0 ? found : search(p, nullptr);
  }

 private:
  using Cell = std::array<std::int32_t, 3>;

  Cell cell_of(const Vec3& p) const {
    Cell cell{};
    for (std::size_t k = 0; k < 3; ++k)
      cell[k] = std::clamp(static_cast<std::int32_t>((p[k] - low_[k]) / cell_), 0, count_[k] - 1);
    return cell;
  }
  std::size_t bin(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return (to_index(i) * to_index(count_[1]) + to_index(j)) * to_index(count_[2]) + to_index(k);
  }
  void insert(std::int32_t m) {
    const Triangle& t = triangles_[to_index(m)];
    Vec3 low = points_[to_index(t[0])], high = low;
    for (const std::int32_t v : t) {
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], points_[to_index(v)][k]);
        high[k] = std::max(high[k], points_[to_index(v)][k]);
      }
    }
    const Cell a = cell_of(low), b = cell_of(high);
    for (auto i = a[0]; i <= b[0]; ++i)
      for (auto j = a[1]; j <= b[1]; ++j)
        for (auto k = a[2]; k <= b[2]; ++k) bins_[bin(i, j, k)].push_back(m);
  }

  std::pair<std::int32_t, NearestPoint> search(const Vec3& p, const Vec3* normal) const {
    std::pair<std::int32_t, NearestPoint> best{-1, {}};
    best.second.distance2 = std::numeric_limits<double>::infinity();
    const Cell home = cell_of(p);
    const std::int32_t rings = *std::max_element(count_.begin(), count_.end());
    for (std::int32_t ring = 0; ring <= rings; ++ring) {
      // Cells of this ring are at least (ring - 1) cells away from a point inside the grid.
      const double reach = cell_ * std::max(0, ring - 1);
      if (best.first >= 0 && reach * reach > best.second.distance2) break;
      visit_ring(home, ring, [&](std::int32_t m) { consider(m, p, normal, best); });
    }
    return best;
  }

  template <class Visit>
  void visit_ring(const Cell& home, std::int32_t ring, const Visit& visit) const {
    Cell a{}, b{};
    for (std::size_t k = 0; k < 3; ++k) {
      a[k] = std::max(0, home[k] - ring);
      b[k] = std::min(count_[k] - 1, home[k] + ring);
    }
    for (auto i = a[0]; i <= b[0]; ++i) {
      for (auto j = a[1]; j <= b[1]; ++j) {
        for (auto k = a[2]; k <= b[2]; ++k) {
          const auto away =
              std::max({std::abs(i - home[0]), std::abs(j - home[1]), std::abs(k - home[2])});
          if (away != ring) continue;
          for (const std::int32_t m : bins_[bin(i, j, k)]) visit(m);
        }
      }
    }
  }

  void consider(std::int32_t m, const Vec3& p, const Vec3* normal,
                std::pair<std::int32_t, NearestPoint>& best) const {
    const Triangle& t = triangles_[to_index(m)];
    const Vec3 &a = points_[to_index(t[0])], &b = points_[to_index(t[1])],
               &c = points_[to_index(t[2])];
    if (normal != nullptr && !(dot(cross(b - a, c - a), *normal) > 0)) return;
    const NearestPoint candidate = nearest_on_triangle(p, a, b, c);
    const bool tie = candidate.distance2 == best.second.distance2 && m < best.first;
    if (candidate.distance2 < best.second.distance2 || tie) best = {m, candidate};
  }

  const std::vector<Vec3>& points_;
  const std::vector<Triangle>& triangles_;
  Vec3 low_{}, high_{};
  double cell_ = 1;
  Cell count_{};
  std::vector<std::vector<std::int32_t>> bins_;
};

void number_boundary(const Body& body, SurfaceMap& map) {
  std::vector<std::int32_t> own(body.nodes.size(), -1);
  for (const Triangle& facet : body.boundary) {
    Triangle renumbered{};
    for (std::size_t i = 0; i < 3; ++i) {
      std::int32_t& number = own[to_index(facet[i])];
      if (number < 0) {
        number = static_cast<std::int32_t>(map.node.size());
        map.node.push_back(facet[i]);
      }
      renumbered[i] = number;
    }
    map.facets.push_back(renumbered);
  }
}

}  // namespace

NearestPoint nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = cross(b - a, c - a);
  const double area2 = dot(normal, normal);
  const std::array<Vec3, 3> corner{a, b, c};
  if (area2 > 0) {
    NearestPoint inside;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 &v = corner[(i + 1) % 3], &w = corner[(i + 2) % 3];
      inside.natural[i] = dot(cross(w - v, p - v), normal) / area2;
    }
    if (*std::min_element(inside.natural.begin(), inside.natural.end()) >= 0) {
      const double height = dot(p - a, normal);
      inside.distance2 = height * height / area2;
      return inside;
    }
  }
  NearestPoint best = nearest_on_edge(p, corner, 0);
  for (std::size_t i = 1; i < 3; ++i) {
    const NearestPoint candidate = nearest_on_edge(p, corner, i);
    if (candidate.distance2 < best.distance2) best = candidate;
  }
  return best;
}

std::vector<double> nearest_values(const std::vector<Vec3>& points,
                                   const std::vector<Vec3>& corners,
                                   const std::vector<Triangle>& triangles,
                                   const std::vector<double>& values) {
  const TriangleGrid grid(corners, triangles);
  std::vector<double> result;
  for (const Vec3& x : points) {
    const auto [triangle, point] = grid.nearest(x);
    double value = 0;
    for (std::size_t i = 0; triangle >= 0 && i < 3; ++i)
      value += point.natural[i] * values[to_index(triangles[to_index(triangle)][i])];
    result.push_back(value);
  }
  return result;
}

SurfaceMap map_boundary(const Body& body) {
  SurfaceMap map;
  number_boundary(body, map);
  std::vector<Vec3> vertices;
  for (const std::int32_t n : body.response.node) vertices.push_back(body.nodes[to_index(n)]);
  if (body.response.triangles.empty()) {
    map.facet_triangle.assign(map.facets.size(), -1);
    map.triangle.assign(map.node.size(), -1);
    map.natural.assign(map.node.size(), Vec3{});
    return map;
  }
  const TriangleGrid grid(vertices, body.response.triangles);
  std::vector<Vec3> point_normal(map.node.size(), Vec3{});
  for (const Triangle& f : map.facets) {
    const auto x = [&](std::size_t i) { return body.nodes[to_index(map.node[to_index(f[i])])]; };
    const Vec3 normal = cross(x(1) - x(0), x(2) - x(0));
    for (const std::int32_t p : f) point_normal[to_index(p)] = point_normal[to_index(p)] + normal;
    const Vec3 centroid = (1.0 / 3) * (x(0) + x(1) + x(2));
    map.facet_triangle.push_back(grid.nearest(centroid, normal).first);
  }
  for (std::size_t p = 0; p < map.node.size(); ++p) {
    const auto [triangle, point] = grid.nearest(body.nodes[to_index(map.node[p])], point_normal[p]);
    map.triangle.push_back(triangle);
    map.natural.push_back(point.natural);
  }
  return map;
}

}  // namespace palpate::report
