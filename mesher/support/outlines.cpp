// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/support/outlines.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <type_traits>
#include <utility>
#include <variant>

#include "format/edge.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/split_edges.hpp"
#include "mesher/read/read_surface.hpp"
#include "mesher/support/supports.hpp"

namespace palpate::mesher {
namespace {

/// Steps of an outline that is not straight in a triangle, over the size of the skin.
constexpr double kStep = 0.25;
constexpr int kBisections = 50;
/// Depth of a face inside a shape at which its points are taken for points of the outline, over the
/// size of the skin: a plane is usually placed a little inside of the flat face that is meant.
constexpr double kShift = 0.05;

/// At most 0 inside a shape, and changes by no more than the distance between two points.
using Level = std::function<double(const Vec3&)>;

Level level_of(const PlaneSupport& plane) {
  return [=, normal = unit(plane.normal)](const Vec3& x) { return -dot(x - plane.point, normal); };
}

Level level_of(const BoxSupport& box) {
  return [=](const Vec3& x) {
    double level = box.low[0] - x[0];
    for (std::size_t k = 0; k < 3; ++k)
      level = std::max({level, box.low[k] - x[k], x[k] - box.high[k]});
    return level;
  };
}

Level level_of(const SphereSupport& sphere) {
  return [=](const Vec3& x) { return norm(x - sphere.centre) - sphere.radius; };
}

Level level_of(const SurfaceSupport& near, const Log& log) {
  const auto surface = std::make_shared<SurfaceQuery>(read_surface(near.surface, log));
  return [=, reach = near.distance](const Vec3& x) {
    const double distance = norm(surface->closest(x).point - x);
    return (surface->contains(x) ? -distance : distance) - reach;
  };
}

/// The level of a zone; none for names.
Level level_of(const Zone& zone, const Log& log) {
  Level level = std::visit(
      [&]<class Shape>(const Shape& shape) -> Level {
        if constexpr (std::is_same_v<Shape, LabelSupport>)
          return {};
        else if constexpr (std::is_same_v<Shape, SurfaceSupport>)
          return level_of(shape, log);
        else
          return level_of(shape);
      },
      zone.shape);
  if (!level || !zone.inverted) return level;
  return [level = std::move(level)](const Vec3& x) { return -level(x); };
}

/// The level of a zone at the points of a surface.
class Levels {
 public:
  Levels(const Surface& surface, Level level, double size)
      : surface_(surface), level_(std::move(level)), size_(size) {
    evaluate();
  }

  /// Adds the points that are new.
  void evaluate() {
    const double tolerance = kSupportTolerance * size_;
    for (std::size_t i = values_.size(); i < surface_.points.size(); ++i) {
      const double value = level_(surface_.points[i]);
      values_.push_back(std::abs(value) <= tolerance ? 0 : value);
    }
    raise_floors(tolerance);
  }

  /// Middles of the edges near the zero that are longer than `step`. No outline crosses a face
  /// whose corners are all on it.
  std::map<Edge, Vec3> long_edges(double step) const {
    std::map<Edge, Vec3> middles;
    for (const Triangle& t : surface_.triangles) {
      if (std::all_of(t.begin(), t.end(), [&](std::int32_t v) { return value(v) == 0; })) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const Edge e = edge_between(t[k], t[(k + 1) % 3]);
        const double length = norm(at(e[1]) - at(e[0]));
        if (length > step && std::min(std::abs(value(e[0])), std::abs(value(e[1]))) <= length)
          middles.emplace(e, 0.5 * (at(e[0]) + at(e[1])));
      }
    }
    return middles;
  }

  /// Where edges cross the zero.
  std::map<Edge, Vec3> crossings() const {
    std::map<Edge, Vec3> found;
    for (const Edge& e : edges_of(surface_.triangles))
      if (value(e[0]) * value(e[1]) < 0) found.emplace(e, crossing(e));
    return found;
  }

  bool contain(const Triangle& t) const {
    return std::all_of(t.begin(), t.end(), [&](std::int32_t v) { return value(v) <= 0; });
  }

 private:
  const Vec3& at(std::int32_t v) const { return surface_.points[to_index(v)]; }
  double value(std::int32_t v) const { return values_[to_index(v)]; }

  /// Points of a face that lies inside by little become points of the outline: none around them
  /// lies further inside.
  void raise_floors(double tolerance) {
    std::vector<bool> is_floor(values_.size(), true);
    for (const Edge& e : edges_of(surface_.triangles)) {
      if (value(e[0]) < value(e[1]) - tolerance) is_floor[to_index(e[1])] = false;
      if (value(e[1]) < value(e[0]) - tolerance) is_floor[to_index(e[0])] = false;
    }
    for (std::size_t i = 0; i < values_.size(); ++i)
      if (is_floor[i] && values_[i] < 0 && values_[i] >= -kShift * size_) values_[i] = 0;
  }

  Vec3 crossing(const Edge& e) const {
    Vec3 below = at(e[0]), above = at(e[1]);
    if (value(e[0]) > 0) std::swap(below, above);
    for (int i = 0; i < kBisections; ++i) {
      const Vec3 middle = 0.5 * (below + above);
      (level_(middle) <= 0 ? below : above) = middle;
    }
    return below;
  }

  const Surface& surface_;
  Level level_;
  double size_;
  std::vector<double> values_;
};

/// Divides triangles where they cross the outline of a zone.
void divide(Surface& surface, const Zone& zone, const Settings& settings) {
  const Level level = level_of(zone, {});
  if (!level) return;
  Levels levels(surface, level, settings.size_of_skin());
  if (!std::holds_alternative<PlaneSupport>(zone.shape)) {
    for (auto middles = levels.long_edges(kStep * settings.size_of_skin()); !middles.empty();
         middles = levels.long_edges(kStep * settings.size_of_skin())) {
      split_edges(surface, middles);
      levels.evaluate();
    }
  }
  split_edges(surface, levels.crossings());
}

/// Marks the triangles inside a zone, none of which crosses its outline.
void mark_inside(const Surface& surface, const Zone& zone, const Settings& settings,
                 std::vector<bool>& inside) {
  if (const auto* named = std::get_if<LabelSupport>(&zone.shape)) {
    const std::vector<bool> has_name =
        entries_with(named->label, surface, settings.source().string());
    for (std::size_t t = 0; t < inside.size(); ++t)
      if (has_name[surface.names[t]] != zone.inverted) inside[t] = true;
    return;
  }
  const Levels levels(surface, level_of(zone, {}), settings.size_of_skin());
  for (std::size_t t = 0; t < inside.size(); ++t)
    if (levels.contain(surface.triangles[t])) inside[t] = true;
}

/// The edges with a triangle inside and one outside.
std::vector<Edge> border(const Surface& surface, const std::vector<bool>& inside) {
  std::map<Edge, int> sides;
  for (std::size_t t = 0; t < inside.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (inside[t])
        ++sides[edge_between(surface.triangles[t][k], surface.triangles[t][(k + 1) % 3])];
  std::vector<Edge> edges;
  for (const auto& [edge, count] : sides)
    if (count == 1) edges.push_back(edge);
  return edges;
}

}  // namespace

OutlinedSurface with_outlines(const Surface& skin, const Settings& settings) {
  OutlinedSurface result{skin, {}};
  Surface& surface = result.surface;
  std::vector<std::vector<Zone>> groups{settings.supports};
  for (const Springs& springs : settings.foundation) groups.push_back({springs.where});
  for (const std::vector<Zone>& group : groups)
    for (const Zone& zone : group) divide(surface, zone, settings);
  for (const std::vector<Zone>& group : groups) {
    std::vector<bool> inside(surface.triangles.size(), false);
    for (const Zone& zone : group) mark_inside(surface, zone, settings, inside);
    std::vector<Edge> outline = border(surface, inside);
    result.parts.push_back({std::move(inside), std::move(outline)});
  }
  return result;
}

}  // namespace palpate::mesher
