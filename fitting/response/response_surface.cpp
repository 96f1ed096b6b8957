// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/response_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace palpate::fitting {
namespace {

double extent_of(const std::vector<Vec3>& points) {
  double extent = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Vec3& point : points) {
      low = std::min(low, point[i]);
      high = std::max(high, point[i]);
    }
    extent = std::max(extent, high - low);
  }
  return extent;
}

std::vector<Vec3> response_points(const Body& body) {
  std::vector<Vec3> points;
  points.reserve(body.response.node.size());
  for (const std::int32_t node : body.response.node)
    points.push_back(body.nodes[static_cast<std::size_t>(node)]);
  return points;
}

/// Components as multiples of a power of two: the products are exact.
void round_to(double step, std::vector<Vec3>& vectors) {
  for (Vec3& vector : vectors)
    for (std::size_t i = 0; i < 3; ++i) vector[i] = step * std::round(vector[i] / step);
}

bool is_pressed(const Body& body, const Triangle& triangle) {
  return std::all_of(triangle.begin(), triangle.end(), [&](std::int32_t v) {
    return body.response.is_site[static_cast<std::size_t>(v)] != 0;
  });
}

}  // namespace

double grid_of(const std::vector<Vec3>& points) {
  const double extent = extent_of(points);
  if (!(extent > 0)) return 0;
  return std::ldexp(1.0, static_cast<int>(std::ceil(std::log2(extent))) - kCoordinateBits);
}

std::vector<Vec3> on_a_grid(std::vector<Vec3> points) {
  const double grid = grid_of(points);
  if (grid > 0) round_to(grid, points);
  return points;
}

void set_response_surface(const Body& body, Library& library) {
  library.positions = on_a_grid(response_points(body));
  library.inward = body.response.inward;
  round_to(std::ldexp(1.0, -kCoordinateBits), library.inward);
  for (const Triangle& triangle : body.response.triangles)
    if (is_pressed(body, triangle)) library.triangles.push_back(triangle);
}

bool has_surface_of(const Body& body, const Library& library) {
  const std::vector<Vec3> points = response_points(body);
  const double grid = grid_of(points);
  return std::equal(points.begin(), points.end(), library.positions.begin(),
                    library.positions.end(),
                    [&](const Vec3& a, const Vec3& b) { return norm(a - b) <= grid; });
}

}  // namespace palpate::fitting
