// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/samples.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "format/to_index.hpp"

namespace palpate::mesher {
namespace {

constexpr int kMostRows = 200;

void sample_triangle(const std::array<Vec3, 3>& corner, double spacing, std::vector<Sample>& out) {
  const Vec3 u = corner[1] - corner[0], v = corner[2] - corner[0];
  const Vec3 normal = cross(u, v);
  if (!(norm(normal) > 0)) return;
  const double longest = std::max({norm(u), norm(v), norm(v - u)});
  const int rows = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 1, kMostRows);
  // The centroids of the rows x rows triangles that the triangle is divided into, those that point
  // the same way: rows (rows + 1) / 2 of them.
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; i + j < rows; ++j) {
      const double a = (i + 1.0 / 3) / rows, b = (j + 1.0 / 3) / rows;
      out.push_back({corner[0] + a * u + b * v, unit(normal)});
    }
  }
}

/// Points in cubes of one edge length.
class Buckets {
 public:
  explicit Buckets(double edge) : edge_(edge) {}

  void add(const Vec3& x) { points_[cube_of(x)].push_back(x); }

  bool any_within(const Vec3& x, double radius) const {
    const Cube low = cube_of(x - Vec3{radius, radius, radius});
    const Cube high = cube_of(x + Vec3{radius, radius, radius});
    for (auto i = low[0]; i <= high[0]; ++i)
      for (auto j = low[1]; j <= high[1]; ++j)
        for (auto k = low[2]; k <= high[2]; ++k)
          if (any_in({i, j, k}, x, radius)) return true;
    return false;
  }

 private:
  using Cube = std::array<std::int64_t, 3>;

  Cube cube_of(const Vec3& x) const {
    Cube cube{};
    for (std::size_t k = 0; k < 3; ++k)
      cube[k] = static_cast<std::int64_t>(std::floor(x[k] / edge_));
    return cube;
  }
  bool any_in(const Cube& cube, const Vec3& x, double radius) const {
    const auto found = points_.find(cube);
    return found != points_.end() &&
           std::any_of(found->second.begin(), found->second.end(),
                       [&](const Vec3& y) { return norm(y - x) < radius; });
  }

  double edge_;
  std::map<Cube, std::vector<Vec3>> points_;
};

}  // namespace

std::vector<Sample> sample_surface(const Surface& surface, double spacing) {
  std::vector<Sample> samples;
  for (const Triangle& t : surface.triangles) {
    const auto corner = [&](std::size_t k) { return surface.points[to_index(t[k])]; };
    sample_triangle({corner(0), corner(1), corner(2)}, spacing, samples);
  }
  return samples;
}

std::vector<std::size_t> thinned(const std::vector<Vec3>& points, const SizeField& spacing) {
  double widest = 0;
  std::vector<double> radius;
  for (const Vec3& x : points) {
    radius.push_back(spacing(x));
    widest = std::max(widest, radius.back());
  }
  Buckets kept_points(widest > 0 ? widest : 1);
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (kept_points.any_within(points[i], radius[i])) continue;
    kept_points.add(points[i]);
    kept.push_back(i);
  }
  return kept;
}

std::vector<Sample> thinned(const std::vector<Sample>& samples, const SizeField& spacing) {
  std::vector<Vec3> points;
  for (const Sample& sample : samples) points.push_back(sample.point);
  std::vector<Sample> kept;
  for (const std::size_t i : thinned(points, spacing)) kept.push_back(samples[i]);
  return kept;
}

Vec3 towards_neighbour(int n) {
  const int i = n % 3, j = n / 3 % 3, k = n / 9;
  return {i - 1.0, j - 1.0, k - 1.0};
}

}  // namespace palpate::mesher
