// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/init/base.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "format/to_index.hpp"

namespace palpate::app {
namespace {

using mesher::Surface;

// A flat base has at least this fraction of the area.
constexpr double kFlatArea = 0.05;
// It is this flat, as a fraction of the extent, and its triangles are this parallel (cosine).
constexpr double kFlatness = 0.005, kParallel = 0.985;
// Heights of a slab as fractions of the extent along its axis, and the area that it needs.
constexpr double kThinnest = 0.1, kThickest = 0.35, kThicker = 0.05, kSlabArea = 0.15;
// Directions are those of an axis from this cosine on.
constexpr double kAlongAxis = 0.99999;

double support_height(const Surface& surface, const Vec3& direction) {
  double top = -std::numeric_limits<double>::infinity();
  for (const Vec3& x : surface.points) top = std::max(top, dot(direction, x));
  return top;
}

Vec3 centroid(const Surface& surface, const Triangle& t) {
  return (1.0 / 3) * (surface.points[to_index(t[0])] + surface.points[to_index(t[1])] +
                      surface.points[to_index(t[2])]);
}

/// How much more a direction counts as down than others.
double preference(const Vec3& down) {
  if (down[2] < -0.9) return 1.25;
  if (down[1] < -0.9) return 1.1;
  return 1;
}

/// Sums of area vectors of triangles that face nearly the same way, the largest first.
std::vector<Vec3> main_directions(const Surface& surface) {
  constexpr double bins = 8;
  constexpr std::size_t most = 24;
  std::map<std::array<long, 3>, Vec3> sums;
  for (const Triangle& t : surface.triangles) {
    const Vec3 area = mesher::area_vector(surface.points, t);
    if (norm(area) == 0) continue;
    const Vec3 n = mesher::unit(area);
    Vec3& sum =
        sums[{std::lround(bins * n[0]), std::lround(bins * n[1]), std::lround(bins * n[2])}];
    sum = sum + area;
  }
  std::vector<Vec3> directions;
  for (const auto& [bin, sum] : sums)
    if (norm(sum) > 0) directions.push_back(sum);
  std::stable_sort(directions.begin(), directions.end(),
                   [](const Vec3& a, const Vec3& b) { return norm(a) > norm(b); });
  directions.resize(std::min(directions.size(), most));
  for (Vec3& d : directions) d = mesher::unit(d);
  return directions;
}

/// Sum of the area vectors of the triangles in the outermost flat part along a direction.
Vec3 flat_part(const Surface& surface, const Vec3& direction, double tolerance) {
  const double lowest = support_height(surface, direction) - tolerance;
  Vec3 sum{};
  for (const Triangle& t : surface.triangles) {
    const Vec3 area = mesher::area_vector(surface.points, t);
    const bool is_outermost = std::all_of(t.begin(), t.end(), [&](std::int32_t v) {
      return dot(direction, surface.points[to_index(v)]) >= lowest;
    });
    if (is_outermost && dot(area, direction) > kParallel * norm(area)) sum = sum + area;
  }
  return sum;
}

/// The direction of an axis where it is nearly that.
Vec3 snapped(const Vec3& direction) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (std::abs(direction[k]) < kAlongAxis) continue;
    Vec3 axis{};
    axis[k] = direction[k] > 0 ? 1 : -1;
    return axis;
  }
  return direction;
}

std::optional<Base> flat_base(const Surface& surface, double area, double extent) {
  const double tolerance = kFlatness * extent;
  std::optional<Base> best;
  double best_score = 0;
  for (const Vec3& rough : main_directions(surface)) {
    const Vec3 part = flat_part(surface, rough, tolerance);
    if (norm(part) == 0) continue;
    const Vec3 down = snapped(mesher::unit(part));
    const double fraction = norm(flat_part(surface, down, tolerance)) / 2 / area;
    const double score = fraction * preference(down);
    if (fraction < kFlatArea || score <= best_score) continue;
    best_score = score;
    best = Base{down, support_height(surface, down) - tolerance, fraction, true};
  }
  return best;
}

/// Area of the triangles in a slab.
double slab_area(const Surface& surface, const Base& slab) {
  double sum = 0;
  for (const Triangle& t : surface.triangles)
    if (slab.holds(centroid(surface, t))) sum += norm(mesher::area_vector(surface.points, t)) / 2;
  return sum;
}

/// The area on which the body would lie, seen from below: that of the triangles that face down,
/// within a height that is the same for all directions.
double footprint(const Surface& surface, const Vec3& down, double extent) {
  const double lowest = support_height(surface, down) - kThinnest * extent;
  double sum = 0;
  for (const Triangle& t : surface.triangles)
    if (dot(down, centroid(surface, t)) >= lowest)
      sum += std::max(0.0, dot(down, mesher::area_vector(surface.points, t))) / 2;
  return sum;
}

Base slab_along(const Surface& surface, const Vec3& down, double area) {
  const double low = support_height(surface, down), high = -support_height(surface, -down);
  Base slab{down, 0, 0, false};
  for (double part = kThinnest; part < kThickest + kThicker / 2; part += kThicker) {
    slab.height = low - part * (low - high);
    slab.fraction = slab_area(surface, slab) / area;
    if (slab.fraction >= kSlabArea) break;
  }
  return slab;
}

Base lowest_slab(const Surface& surface, double area, double extent) {
  Vec3 best{0, 0, -1};
  double best_score = -1;
  for (const Vec3& down : {Vec3{0, 0, -1}, Vec3{0, -1, 0}, Vec3{-1, 0, 0}, Vec3{0, 0, 1},
                           Vec3{0, 1, 0}, Vec3{1, 0, 0}}) {
    const double score = footprint(surface, down, extent) * preference(down);
    if (score <= best_score) continue;
    best_score = score;
    best = down;
  }
  return slab_along(surface, best, area);
}

}  // namespace

Base find_base(const Surface& surface) {
  const double area = mesher::area(surface);
  const double extent = mesher::largest_dimension(surface.points);
  const auto flat = flat_base(surface, area, extent);
  return flat ? *flat : lowest_slab(surface, area, extent);
}

}  // namespace palpate::app
