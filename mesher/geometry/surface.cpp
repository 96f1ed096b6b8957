// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/geometry/surface.hpp"

#include <algorithm>

#include "format/to_index.hpp"
#include "mesher/geometry/text.hpp"

namespace palpate::mesher {

Bounds bounds(const std::vector<Vec3>& points) {
  Bounds box{points.at(0), points.at(0)};
  for (const Vec3& p : points) {
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = std::min(box.low[k], p[k]);
      box.high[k] = std::max(box.high[k], p[k]);
    }
  }
  return box;
}

std::string extent_of(const std::vector<Vec3>& points) {
  const Bounds box = bounds(points);
  return text(position_text(box.low), " to ", position_text(box.high));
}

double largest_dimension(const std::vector<Vec3>& points) {
  const Bounds box = bounds(points);
  const Vec3 size = box.high - box.low;
  return std::max({size[0], size[1], size[2]});
}

Vec3 area_vector(const std::vector<Vec3>& points, const Triangle& triangle) {
  const Vec3& a = points[to_index(triangle[0])];
  const Vec3& b = points[to_index(triangle[1])];
  const Vec3& c = points[to_index(triangle[2])];
  return cross(b - a, c - a);
}

double area(const Surface& surface) {
  double sum = 0;
  for (const Triangle& t : surface.triangles) sum += norm(area_vector(surface.points, t)) / 2;
  return sum;
}

double signed_volume(const Surface& surface) {
  if (surface.points.empty()) return 0;
  const Vec3& origin = surface.points.front();
  double sum = 0;
  for (const Triangle& t : surface.triangles) {
    sum += dot(surface.points[to_index(t[0])] - origin, area_vector(surface.points, t));
  }
  return sum / 6;
}

double mean_thickness(const Surface& surface) {
  const double sides = area(surface);
  return sides > 0 ? 2 * signed_volume(surface) / sides : 0;
}

void append(Surface& surface, const Surface& more) {
  const auto offset = static_cast<std::int32_t>(surface.points.size());
  surface.points.insert(surface.points.end(), more.points.begin(), more.points.end());
  for (const Triangle& t : more.triangles) {
    surface.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
}

std::vector<std::vector<std::int32_t>> incident_triangles(std::size_t points,
                                                          const std::vector<Triangle>& triangles) {
  std::vector<std::vector<std::int32_t>> around(points);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const std::int32_t v : triangles[t]) {
      around[to_index(v)].push_back(static_cast<std::int32_t>(t));
    }
  }
  return around;
}

Vec3 unit(const Vec3& a) {
  return (1 / norm(a)) * a;
}

double distance_to_triangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto to_segment = [&](const Vec3& p, const Vec3& q) {
    const Vec3 pq = q - p;
    const double length2 = dot(pq, pq);
    const double s = length2 > 0 ? std::clamp(dot(x - p, pq) / length2, 0.0, 1.0) : 0.0;
    return norm(x - p - s * pq);
  };
  const Vec3 n = cross(b - a, c - a);
  const bool above = dot(cross(b - a, x - a), n) >= 0 && dot(cross(c - b, x - b), n) >= 0 &&
                     dot(cross(a - c, x - c), n) >= 0;
  if (above && norm(n) > 0) return std::abs(dot(x - a, n)) / norm(n);
  return std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
}

}  // namespace palpate::mesher
