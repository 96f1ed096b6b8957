// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/unit/mesher/shapes.hpp"

#include <unistd.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

namespace palpate::mesher::test {
namespace {

/// Circles with equal numbers of points, joined from the south pole or cap centre to the north.
Surface lathe(const std::vector<std::vector<Vec3>>& circles, const Vec3& south, const Vec3& north) {
  Surface s;
  const auto around = static_cast<std::int32_t>(circles.front().size());
  const auto rows = static_cast<std::int32_t>(circles.size());
  for (const auto& circle : circles) s.points.insert(s.points.end(), circle.begin(), circle.end());
  s.points.push_back(south);
  s.points.push_back(north);
  for (std::int32_t k = 0; k < around; ++k) {
    const std::int32_t next = (k + 1) % around;
    for (std::int32_t r = 0; r + 1 < rows; ++r) {
      const std::int32_t a = r * around + k, b = r * around + next;
      s.triangles.push_back({a, b, b + around});
      s.triangles.push_back({a, b + around, a + around});
    }
    s.triangles.push_back({rows * around, next, k});
    const std::int32_t last = (rows - 1) * around;
    s.triangles.push_back({rows * around + 1, last + k, last + next});
  }
  return s;
}

std::vector<Vec3> circle(double radius, double z, int count) {
  std::vector<Vec3> points;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count;
    points.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
  }
  return points;
}

}  // namespace

Surface sphere(const Vec3& centre, double radius, int meridians) {
  const int rows = meridians / 2;
  std::vector<std::vector<Vec3>> circles;
  for (int r = 1; r < rows; ++r) {
    const double polar = std::numbers::pi * (1 - static_cast<double>(r) / rows);
    circles.push_back(circle(radius * std::sin(polar), radius * std::cos(polar), meridians));
  }
  Surface s = lathe(circles, {0, 0, -radius}, {0, 0, radius});
  for (Vec3& x : s.points) x = x + centre;
  return s;
}

Surface cylinder(double radius, double length, int around) {
  constexpr int rings = 4, levels = 16;
  std::vector<std::vector<Vec3>> circles;
  for (int r = 1; r < rings; ++r) circles.push_back(circle(radius * r / rings, 0, around));
  for (int l = 0; l <= levels; ++l) circles.push_back(circle(radius, length * l / levels, around));
  for (int r = rings - 1; r > 0; --r) circles.push_back(circle(radius * r / rings, length, around));
  return lathe(circles, {0, 0, 0}, {0, 0, length});
}

Surface box(const Vec3& low, const Vec3& high) {
  Surface s;
  for (std::size_t i = 0; i < 8; ++i) {
    s.points.push_back({(i & 1U) != 0 ? high[0] : low[0], (i & 2U) != 0 ? high[1] : low[1],
                        (i & 4U) != 0 ? high[2] : low[2]});
  }
  s.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return s;
}

TemporaryFile::TemporaryFile(const std::string& name, const std::string& content)
    : path_(std::filesystem::temp_directory_path() /
            ("palpate_" + std::to_string(getpid()) + "_" + name)) {
  std::ofstream(path_, std::ios::binary) << content;
}

TemporaryFile::~TemporaryFile() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

std::string off_text(const Surface& surface) {
  std::ostringstream out;
  out.precision(17);
  out << "OFF\n" << surface.points.size() << ' ' << surface.triangles.size() << " 0\n";
  for (const Vec3& x : surface.points) out << x[0] << ' ' << x[1] << ' ' << x[2] << '\n';
  for (const Triangle& t : surface.triangles) {
    out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  }
  return out.str();
}

}  // namespace palpate::mesher::test
