// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/skin/smooth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "format/edge.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/queries.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/geometry/union_find.hpp"
#include "mesher/skin/sharp_edges.hpp"

namespace palpate::mesher {
namespace {

constexpr double kStraight = 1e-4;  // of an edge, which bulges less: it is not halved
constexpr std::size_t kMostTriangles = 4'000'000;

using Normals = std::array<Vec3, 3>;   // at the corners of a triangle
using Tangents = std::array<Vec3, 2>;  // at the ends of an edge, from the lower index to the higher

/// The cubic of an edge from A to B: control points at a third.
struct Cubic {
  Vec3 a, at_a, at_b, b;

  Vec3 middle() const { return 0.125 * (a + 3 * at_a + 3 * at_b + b); }
  Vec3 tangent() const { return unit(b + at_b - at_a - a); }  ///< in the middle
};

Cubic normal_to(const Vec3& a, const Vec3& b, const Vec3& normal_a, const Vec3& normal_b) {
  const Vec3 third = (1.0 / 3) * (b - a);
  return {a, a + third - dot(third, normal_a) * normal_a,
          b - third + dot(third, normal_b) * normal_b, b};
}

Cubic along(const Vec3& a, const Vec3& b, const Tangents& tangents) {
  const Vec3 third = (1.0 / 3) * (b - a);
  return {a, a + dot(third, tangents[0]) * tangents[0], b - dot(third, tangents[1]) * tangents[1],
          b};
}

Vec3 across(const Vec3& v, const Vec3& tangent) {
  return unit(v - dot(v, tangent) * tangent);
}

/// The angle of a triangle at a corner, rad.
double corner_angle(const Surface& surface, const Triangle& t, std::size_t corner) {
  const auto at = [&](std::size_t i) { return surface.points[to_index(t[i % 3])]; };
  const Vec3 one = at(corner + 1) - at(corner), other = at(corner + 2) - at(corner);
  return std::atan2(norm(cross(one, other)), dot(one, other));
}

/// From corner i on.
Edge edge_of(const Triangle& t, std::size_t i) {
  return edge_between(t[i], t[(i + 1) % 3]);
}

/// The triangles at both sides of each edge.
std::map<Edge, std::vector<std::size_t>> sides_of_edges(const Surface& surface) {
  std::map<Edge, std::vector<std::size_t>> sides;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) sides[edge_of(surface.triangles[t], i)].push_back(t);
  return sides;
}

std::size_t corner_of(const Triangle& t, std::int32_t vertex) {
  return static_cast<std::size_t>(std::find(t.begin(), t.end(), vertex) - t.begin());
}

/// One normal for all corners of a vertex that no sharp edge separates.
std::vector<Normals> corner_normals(const Surface& surface, const std::map<Edge, Tangents>& sharp) {
  UnionFind fans(3 * surface.triangles.size());
  for (const auto& [edge, sides] : sides_of_edges(surface)) {
    if (sharp.count(edge) > 0 || sides.size() != 2) continue;
    for (const std::int32_t vertex : {edge[0], edge[1]})
      fans.join(3 * sides[0] + corner_of(surface.triangles[sides[0]], vertex),
                3 * sides[1] + corner_of(surface.triangles[sides[1]], vertex));
  }
  std::vector<Vec3> sums(3 * surface.triangles.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Vec3 normal = unit(area_vector(surface.points, surface.triangles[t]));
    for (std::size_t i = 0; i < 3; ++i) {
      Vec3& sum = sums[fans.root(3 * t + i)];
      sum = sum + corner_angle(surface, surface.triangles[t], i) * normal;
    }
  }
  std::vector<Normals> normals(surface.triangles.size());
  for (std::size_t t = 0; t < normals.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) normals[t][i] = unit(sums[fans.root(3 * t + i)]);
  return normals;
}

/// Tangents of sharp edges: those of the circle through three points of a line of them.
std::map<Edge, Tangents> tangents_of(const Surface& surface, const std::vector<Edge>& edges,
                                     double feature_angle) {
  std::map<std::int32_t, std::vector<std::int32_t>> next;
  for (const Edge& edge : edges) {
    next[edge[0]].push_back(edge[1]);
    next[edge[1]].push_back(edge[0]);
  }
  const auto x = [&](std::int32_t v) { return surface.points[to_index(v)]; };
  const auto tangent = [&](std::int32_t at, const Vec3& straight) {
    const std::vector<std::int32_t>& ends = next[at];
    if (ends.size() != 2) return straight;
    const Vec3 in = x(at) - x(ends[0]), out = x(ends[1]) - x(at);
    if (dot(unit(in), unit(out)) < std::cos(feature_angle)) return straight;
    const Vec3 circle = unit(norm(out) * unit(in) + norm(in) * unit(out));
    return dot(circle, straight) < 0 ? -circle : circle;
  };
  std::map<Edge, Tangents> tangents;
  for (const Edge& edge : edges) {
    const Vec3 straight = unit(x(edge[1]) - x(edge[0]));
    tangents[edge] = {tangent(edge[0], straight), tangent(edge[1], straight)};
  }
  return tangents;
}

/// Halves the curved edges of a surface in rounds.
class Smoothing {
 public:
  Smoothing(const Surface& surface, const SmoothSettings& settings)
      : surface_(surface),
        longest_(settings.longest),
        sharp_(tangents_of(surface, sharp_edges(surface, settings.feature_angle, settings.spacing),
                           settings.feature_angle)),
        normals_(corner_normals(surface, sharp_)) {}

  /// @return whether an edge was halved
  bool halve_edges() {
    mark_curved();
    if (marked_.empty()) return false;
    mark_longest();
    middles_.clear();
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i) halve(t, i);
    const std::size_t before = surface_.triangles.size();
    for (std::size_t t = 0; t < before; ++t) divide(t);
    halve_sharp();
    return true;
  }
  const Surface& surface() const { return surface_; }

 private:
  /// A corner of a triangle, or a middle of its edges.
  struct Corner {
    std::int32_t vertex = -1;
    Vec3 normal{};
  };
  using Part = std::array<Corner, 3>;

  const Vec3& x(std::int32_t v) const { return surface_.points[to_index(v)]; }

  Cubic cubic(const Edge& edge) const { return along(x(edge[0]), x(edge[1]), sharp_.at(edge)); }
  /// The edge from corner i on.
  Cubic cubic(std::size_t t, std::size_t i) const {
    const Triangle& corners = surface_.triangles[t];
    const Edge edge = edge_of(corners, i);
    if (sharp_.count(edge) > 0) return cubic(edge);
    const std::size_t j = (i + 1) % 3;
    return normal_to(x(corners[i]), x(corners[j]), normals_[t][i], normals_[t][j]);
  }

  /// Marks the long edges that are curved.
  void mark_curved() {
    marked_.clear();
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Edge edge = edge_of(surface_.triangles[t], i);
        if (!(length(edge) > longest_)) continue;
        const Vec3 bulge = cubic(t, i).middle() - 0.5 * (x(edge[0]) + x(edge[1]));
        if (norm(bulge) > kStraight * length(edge)) marked_.insert(edge);
      }
    }
  }

  /// Marks the longest edge of every triangle with a mark: triangles beside a straight edge would
  /// otherwise become thinner and thinner [Rivara 1984].
  void mark_longest() {
    for (bool changed = true; changed;) {
      changed = false;
      for (const Triangle& t : surface_.triangles) {
        Edge longest = edge_of(t, 0);
        bool has_mark = false;
        for (std::size_t i = 0; i < 3; ++i) {
          const Edge edge = edge_of(t, i);
          has_mark = has_mark || marked_.count(edge) > 0;
          if (length(edge) > length(longest)) longest = edge;
        }
        if (has_mark && marked_.insert(longest).second) changed = true;
      }
    }
  }

  double length(const Edge& edge) const { return norm(x(edge[1]) - x(edge[0])); }

  void halve(std::size_t t, std::size_t i) {
    const Edge edge = edge_of(surface_.triangles[t], i);
    if (marked_.count(edge) == 0 || middles_.count(edge) > 0) return;
    middles_[edge] = static_cast<std::int32_t>(surface_.points.size());
    surface_.points.push_back(cubic(t, i).middle());
  }

  Corner corner(std::size_t t, std::size_t i) const {
    return {surface_.triangles[t][i % 3], normals_[t][i % 3]};
  }
  /// The middle of the edge from corner i on; vertex -1 where it is whole.
  Corner middle(std::size_t t, std::size_t i) const {
    const auto found = middles_.find(edge_of(surface_.triangles[t], i % 3));
    if (found == middles_.end()) return {};
    const Vec3 mean = corner(t, i).normal + corner(t, i + 1).normal;
    return {found->second, across(mean, cubic(t, i % 3).tangent())};
  }

  void divide(std::size_t t) {
    const std::array<Corner, 3> middles{middle(t, 0), middle(t, 1), middle(t, 2)};
    std::size_t count = 0, halved = 0, whole = 0;  // edges: the last that is halved, or whole
    for (std::size_t i = 0; i < 3; ++i) {
      const bool is_halved = middles[i].vertex >= 0;
      count += is_halved ? 1 : 0;
      (is_halved ? halved : whole) = i;
    }
    if (count == 1) replace(t, by_one(t, halved, middles[halved]));
    if (count == 2)
      replace(t, by_two(t, whole, middles[(whole + 1) % 3], middles[(whole + 2) % 3]));
    if (count == 3) replace(t, by_three(t, middles));
  }

  std::vector<Part> by_one(std::size_t t, std::size_t i, const Corner& m) const {
    const Corner a = corner(t, i), b = corner(t, i + 1), c = corner(t, i + 2);
    return {{a, m, c}, {m, b, c}};
  }
  /// The edge from corner i on is whole; m and n halve those after it.
  std::vector<Part> by_two(std::size_t t, std::size_t i, const Corner& m, const Corner& n) const {
    const Corner a = corner(t, i), b = corner(t, i + 1), c = corner(t, i + 2);
    if (norm(x(m.vertex) - x(a.vertex)) < norm(x(n.vertex) - x(b.vertex)))
      return {{m, c, n}, {a, b, m}, {a, m, n}};
    return {{m, c, n}, {a, b, n}, {b, m, n}};
  }
  std::vector<Part> by_three(std::size_t t, const std::array<Corner, 3>& m) const {
    return {{corner(t, 0), m[0], m[2]}, {m[0], corner(t, 1), m[1]}, {m[2], m[1], corner(t, 2)}, m};
  }

  void replace(std::size_t t, const std::vector<Part>& parts) {
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const Part& part = parts[k];
      const Triangle corners{part[0].vertex, part[1].vertex, part[2].vertex};
      const Normals normals{part[0].normal, part[1].normal, part[2].normal};
      if (k == 0) {
        surface_.triangles[t] = corners;
        normals_[t] = normals;
        continue;
      }
      surface_.triangles.push_back(corners);
      normals_.push_back(normals);
      if (!surface_.names.empty()) surface_.names.push_back(surface_.names[t]);
    }
  }

  void halve_sharp() {
    for (const auto& [edge, middle] : middles_) {
      const auto found = sharp_.find(edge);
      if (found == sharp_.end()) continue;
      const Tangents ends = found->second;
      const Vec3 tangent = cubic(edge).tangent();
      sharp_.erase(found);
      // A middle has a higher index than the ends of its edge.
      sharp_[{edge[0], middle}] = {ends[0], tangent};
      sharp_[{edge[1], middle}] = {-ends[1], -tangent};
    }
  }

  Surface surface_;
  double longest_;
  std::map<Edge, Tangents> sharp_;
  std::vector<Normals> normals_;  // of each triangle
  std::set<Edge> marked_;         // to be halved
  std::map<Edge, std::int32_t> middles_;
};

void check_crossings(const Surface& surface, const std::string& where) {
  const std::vector<TrianglePair> pairs = self_intersections(surface);
  if (pairs.empty()) return;
  const Triangle& first = surface.triangles[to_index(pairs.front().first)];
  refuse_geometry(where,
                  text("the smooth surface self-intersects in ", counted(pairs.size(), "place"),
                       ", the first near ", position_text(surface.points[to_index(first[0])])),
                  "set surface.smooth = false");
}

}  // namespace

Surface smooth(const Surface& surface, const SmoothSettings& settings, const std::string& where) {
  Smoothing smoothing(surface, settings);
  while (smoothing.halve_edges()) {
    if (smoothing.surface().triangles.size() > kMostTriangles)
      refuse(where,
             text("the smooth surface has more than ", kMostTriangles, " triangles that are ",
                  millimetres(settings.longest), " wide"),
             "increase mesh.element_size, or set surface.smooth = false");
  }
  check_crossings(smoothing.surface(), where);
  return smoothing.surface();
}

}  // namespace palpate::mesher
