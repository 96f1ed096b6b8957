// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/simulate/surface_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <queue>
#include <utility>

#include "format/error.hpp"
#include "format/number_text.hpp"
#include "format/position_text.hpp"

namespace palpate::app {
namespace {

constexpr std::int32_t kNone = -1;

Vec3 unit(const Vec3& v) {
  return (1 / norm(v)) * v;
}

/// The triangles that have responses and who is next to whom.
class TouchableSurface {
 public:
  explicit TouchableSurface(const Library& library) : library_(library) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> edges;
    neighbours_.assign(library.triangles.size(), {kNone, kNone, kNone});
    for (std::size_t m = 0; m < library.triangles.size(); ++m) {
      if (!touchable(m)) continue;
      for (std::size_t side = 0; side < 3; ++side) {
        edges[directed(m, side)] = static_cast<std::int32_t>(m);
      }
    }
    for (std::size_t m = 0; m < library.triangles.size(); ++m) {
      if (!touchable(m)) continue;
      for (std::size_t side = 0; side < 3; ++side) {
        const auto [a, b] = directed(m, side);
        const auto other = edges.find({b, a});
        if (other != edges.end()) neighbours_[m][side] = other->second;
      }
    }
  }

  bool touchable(std::size_t m) const {
    return std::all_of(library_.triangles[m].begin(), library_.triangles[m].end(), [&](auto v) {
      return library_.responses[static_cast<std::size_t>(v)].status != ResponseStatus::Hole;
    });
  }
  std::int32_t neighbour(std::size_t m, std::size_t side) const { return neighbours_[m][side]; }
  Vec3 corner(std::size_t m, std::size_t i) const { return library_.positions[vertex(m, i)]; }
  Vec3 centroid(std::size_t m) const {
    return (1.0 / 3) * (corner(m, 0) + corner(m, 1) + corner(m, 2));
  }
  Vec3 normal(std::size_t m) const {
    return unit(cross(corner(m, 1) - corner(m, 0), corner(m, 2) - corner(m, 0)));
  }
  /// sum n_l u_l / |sum n_l u_l| at a point of the triangle, n_l its natural coordinates.
  Vec3 inward(std::size_t m, const Vec3& p) const {
    const Vec3 n = normal(m);
    Vec3 sum{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 a = corner(m, (i + 1) % 3), b = corner(m, (i + 2) % 3);
      const double twice_area = dot(cross(b - a, p - a), n);
      sum = sum + twice_area * library_.inward[vertex(m, i)];
    }
    return unit(sum);
  }
  std::size_t size() const { return library_.triangles.size(); }

 private:
  std::size_t vertex(std::size_t m, std::size_t i) const {
    return static_cast<std::size_t>(library_.triangles[m][i]);
  }
  std::pair<std::int32_t, std::int32_t> directed(std::size_t m, std::size_t side) const {
    return {library_.triangles[m][side], library_.triangles[m][(side + 1) % 3]};
  }

  const Library& library_;
  std::vector<std::array<std::int32_t, 3>> neighbours_;
};

struct Exit {
  double distance;  ///< along the direction
  std::size_t side;
};

/// Where a ray inside triangle m leaves it: the nearest side it moves towards.
Exit exit_of(const TouchableSurface& surface, std::size_t m, const Vec3& p, const Vec3& direction) {
  const Vec3 n = surface.normal(m);
  Exit exit{std::numeric_limits<double>::infinity(), 0};
  for (std::size_t side = 0; side < 3; ++side) {
    const Vec3 a = surface.corner(m, side), b = surface.corner(m, (side + 1) % 3);
    const Vec3 inside = unit(cross(n, b - a));
    const double approach = -dot(direction, inside);
    if (approach <= 1e-12) continue;
    const double distance = std::max(0.0, dot(p - a, inside)) / approach;
    if (distance < exit.distance) exit = {distance, side};
  }
  return exit;
}

/// The direction in the plane of a triangle; nothing when it is nearly perpendicular to it.
std::optional<Vec3> projected(const Vec3& direction, const Vec3& normal) {
  const Vec3 in_plane = direction - dot(direction, normal) * normal;
  if (norm(in_plane) < 1e-3) return std::nullopt;
  return unit(in_plane);
}

/// Points of a straight piece inside triangle m, at most `step` apart.
void append_piece(std::vector<PathPoint>& path, const TouchableSurface& surface, std::size_t m,
                  const Vec3& direction, double length, double step) {
  const PathPoint start = path.back();
  const int points = std::max(1, static_cast<int>(std::ceil(length / step)));
  for (int i = 1; i <= points; ++i) {
    const double along = length * i / points;
    const Vec3 q = start.position + along * direction;
    path.push_back({start.distance + along, q, surface.inward(m, q)});
  }
}

std::vector<PathPoint> walk(const TouchableSurface& surface, std::size_t start, Vec3 direction,
                            double length, double step) {
  std::size_t m = start;
  const Vec3 middle = surface.centroid(m);
  std::vector<PathPoint> path{{0, middle, surface.inward(m, middle)}};
  while (path.back().distance < length) {
    const std::optional<Vec3> t = projected(direction, surface.normal(m));
    if (!t) break;
    direction = *t;
    const Exit exit = exit_of(surface, m, path.back().position, direction);
    const double part = std::min(exit.distance, length - path.back().distance);
    append_piece(path, surface, m, direction, part, step);
    const std::int32_t next = surface.neighbour(m, exit.side);
    if (part < exit.distance || next == kNone) break;
    m = static_cast<std::size_t>(next);
  }
  return path;
}

[[noreturn]] void refuse_without_responses(const Library& library) {
  throw Error(ErrorKind::Configuration, library.name, "no triangle of the library has responses",
              "look at the failed sites with `palpate inspect`");
}

/// The triangle with responses whose middle is nearest to a point.
std::size_t triangle_near(const Library& library, const TouchableSurface& surface,
                          const Vec3& point, const char* key) {
  const auto distance = [&](std::size_t m) { return norm(surface.centroid(m) - point); };
  std::optional<std::size_t> nearest;
  for (std::size_t m = 0; m < surface.size(); ++m) {
    if (surface.touchable(m) && (!nearest || distance(m) < distance(*nearest))) nearest = m;
  }
  if (!nearest) refuse_without_responses(library);
  double longest_edge = 0;
  for (std::size_t side = 0; side < 3; ++side) {
    const Vec3 edge = surface.corner(*nearest, (side + 1) % 3) - surface.corner(*nearest, side);
    longest_edge = std::max(longest_edge, norm(edge));
  }
  if (distance(*nearest) > longest_edge) {
    throw Error(ErrorKind::Configuration, fmt::format("simulate.{}", key),
                fmt::format("the nearest triangle with responses is {} away",
                            length_text(distance(*nearest))),
                "choose a point of the surface inside a press zone");
  }
  return *nearest;
}

[[noreturn]] void refuse_interrupted(const Vec3& end, const Vec3& to) {
  throw Error(ErrorKind::Configuration, "simulate.path",
              fmt::format("the surface with responses ends at {}, {} "
                          "before the end of the slide",
                          position_text(end), length_text(norm(to - end))),
              "choose two points without a hole, a support or a ridge between them");
}

/// A tool that keeps its depth round a rim is far beyond the other side of it.
void end_before_a_rim(std::vector<PathPoint>& path) {
  constexpr double kTurn = 0.5;  // cosine of 60 degrees
  const Vec3 start = path.front().inward;
  const auto beyond = std::find_if(path.begin(), path.end(), [&](const PathPoint& point) {
    return dot(point.inward, start) < kTurn;
  });
  path.erase(beyond, path.end());
}

}  // namespace

std::size_t middle_triangle(const Library& library) {
  const TouchableSurface surface(library);
  std::vector<int> rings(surface.size(), -1);
  std::queue<std::size_t> front;
  std::optional<std::size_t> middle;
  for (std::size_t m = 0; m < surface.size(); ++m) {
    if (!surface.touchable(m)) continue;
    if (!middle) middle = m;  // a closed surface without border has no middle
    for (std::size_t side = 0; side < 3 && rings[m] < 0; ++side) {
      if (surface.neighbour(m, side) != kNone) continue;
      rings[m] = 0;
      front.push(m);
    }
  }
  if (!middle) refuse_without_responses(library);
  for (; !front.empty(); front.pop()) {
    const std::size_t m = front.front();
    if (rings[m] > rings[*middle]) middle = m;
    for (std::size_t side = 0; side < 3; ++side) {
      const std::int32_t next = surface.neighbour(m, side);
      if (next == kNone || rings[static_cast<std::size_t>(next)] >= 0) continue;
      rings[static_cast<std::size_t>(next)] = rings[m] + 1;
      front.push(static_cast<std::size_t>(next));
    }
  }
  return *middle;
}

std::vector<PathPoint> straight_path(const Library& library, std::size_t start, double length,
                                     double step) {
  constexpr int kDirections = 16;
  const TouchableSurface surface(library);
  const Vec3 first = unit(surface.corner(start, 1) - surface.corner(start, 0));
  const Vec3 second = cross(surface.normal(start), first);
  std::vector<PathPoint> longest;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDirections;
    const Vec3 direction = std::cos(angle) * first + std::sin(angle) * second;
    std::vector<PathPoint> path = walk(surface, start, direction, length, step);
    end_before_a_rim(path);
    constexpr double kWorthwhile = 1 + 1e-7;  // equal lengths: the first direction stays
    if (longest.empty() || path.back().distance > kWorthwhile * longest.back().distance) {
      longest = std::move(path);
    }
  }
  return longest;
}

std::vector<PathPoint> path_between(const Library& library, const Vec3& from, const Vec3& to,
                                    double step) {
  const TouchableSurface surface(library);
  std::size_t m = triangle_near(library, surface, from, "from");
  const std::size_t last = triangle_near(library, surface, to, "to");
  const Vec3 start = surface.centroid(m), end = surface.centroid(last);
  std::vector<PathPoint> path{{0, start, surface.inward(m, start)}};
  // A walk that crosses more triangles than there are goes to and fro.
  for (std::size_t crossed = 0; m != last; ++crossed) {
    const Vec3& p = path.back().position;
    const std::optional<Vec3> direction = projected(unit(end - p), surface.normal(m));
    if (!direction || crossed > surface.size()) refuse_interrupted(p, end);
    const Exit exit = exit_of(surface, m, p, *direction);
    append_piece(path, surface, m, *direction, exit.distance, step);
    const std::int32_t next = surface.neighbour(m, exit.side);
    if (next == kNone) refuse_interrupted(path.back().position, end);
    m = static_cast<std::size_t>(next);
  }
  const Vec3 rest = end - path.back().position;
  if (norm(rest) > 0) append_piece(path, surface, m, unit(rest), norm(rest), step);
  return path;
}

PathPoint point_at(const std::vector<PathPoint>& path, double distance) {
  const auto after =
      std::lower_bound(path.begin(), path.end(), distance,
                       [](const PathPoint& point, double value) { return point.distance < value; });
  if (after == path.begin()) return path.front();
  if (after == path.end()) return path.back();
  const PathPoint& a = *(after - 1);
  const PathPoint& b = *after;
  const double fraction = (distance - a.distance) / (b.distance - a.distance);
  return {distance, (1 - fraction) * a.position + fraction * b.position,
          unit((1 - fraction) * a.inward + fraction * b.inward)};
}

}  // namespace palpate::app
