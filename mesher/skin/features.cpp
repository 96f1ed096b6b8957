// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/skin/features.hpp"

#include <CGAL/Polygon_mesh_processing/detect_features.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "mesher/geometry/union_find.hpp"

namespace palpate::mesher {
namespace {

double length(const Mesh& mesh, Mesh::Edge_index edge) {
  const auto h = mesh.halfedge(edge);
  return std::sqrt(CGAL::squared_distance(mesh.point(mesh.source(h)), mesh.point(mesh.target(h))));
}

/// Unflags connected fragments of sharp edges shorter than `shortest`. Returns the edges unflagged.
std::size_t drop_short_features(const Mesh& mesh, EdgeFlags sharp, double shortest) {
  UnionFind joined(mesh.number_of_vertices());
  const auto root = [&](Mesh::Edge_index e) {
    return joined.root(mesh.source(mesh.halfedge(e)).idx());
  };
  for (const auto e : mesh.edges()) {
    if (!sharp[e]) continue;
    const auto h = mesh.halfedge(e);
    joined.join(mesh.source(h).idx(), mesh.target(h).idx());
  }
  std::map<std::size_t, double> total;
  for (const auto e : mesh.edges()) {
    if (sharp[e]) total[root(e)] += length(mesh, e);
  }
  std::size_t dropped = 0;
  for (const auto e : mesh.edges()) {
    if (sharp[e] && total[root(e)] < shortest) {
      sharp[e] = false;
      ++dropped;
    }
  }
  return dropped;
}

/// Distance from flagged edges, over the spacing, within which an edge of about their direction
/// runs beside them; and the least cosine of the two.
constexpr double kBeside = 0.5, kLeastCosine = 0.7;

struct Segment {
  Vec3 a, b;
};

Segment segment_of(const Mesh& mesh, Mesh::Edge_index edge) {
  const auto h = mesh.halfedge(edge);
  return {to_vec3(mesh.point(mesh.source(h))), to_vec3(mesh.point(mesh.target(h)))};
}

bool runs_beside(const Segment& one, const Segment& other, double distance) {
  const Vec3 along = one.b - one.a, beside = other.b - other.a;
  const Vec3 from = 0.5 * (one.a + one.b) - other.a;
  const double length = norm(beside);
  const double at = std::clamp(dot(from, beside) / (length * length), 0.0, 1.0);
  return norm(from - at * beside) < distance &&
         std::abs(dot(along, beside)) > kLeastCosine * norm(along) * length;
}

/// How far from a corner its turn is seen, over the spacing; and the cosine of the least turn.
constexpr double kCornerReach = 0.5, kCornerCosine = 0.7071;

/// The lines that flagged edges make.
class FlaggedLines {
 public:
  FlaggedLines(const Mesh& mesh, const EdgeFlags& flags) : mesh_(mesh), flags_(flags) {}

  /// The cosine of the angle between the ways to v and from it, each as long as `reach` where the
  /// line is; 1 where v is not inside a line.
  double cosine_of_turn(Mesh::Vertex_index v, double reach) const {
    const auto next = neighbours(v);
    if (next.size() != 2) return 1;
    const Vec3 to = at(v) - along(v, next[0], reach), from = along(v, next[1], reach) - at(v);
    return dot(to, from) / (norm(to) * norm(from));
  }

 private:
  Vec3 at(Mesh::Vertex_index v) const { return to_vec3(mesh_.point(v)); }

  std::vector<Mesh::Vertex_index> neighbours(Mesh::Vertex_index v) const {
    std::vector<Mesh::Vertex_index> found;
    for (const auto h : mesh_.halfedges_around_target(mesh_.halfedge(v)))
      if (flags_[mesh_.edge(h)]) found.push_back(mesh_.source(h));
    return found;
  }

  /// The point that lies `reach` along the line from v by way of `by`, or where the line ends.
  Vec3 along(Mesh::Vertex_index v, Mesh::Vertex_index by, double reach) const {
    Mesh::Vertex_index before = v;
    for (;;) {
      const Vec3 a = at(before), b = at(by);
      const double length = norm(b - a);
      if (length >= reach) return a + (reach / length) * (b - a);
      reach -= length;
      const auto next = neighbours(by);
      if (next.size() != 2 || by == v) return b;
      before = std::exchange(by, next[0] == before ? next[1] : next[0]);
    }
  }

  const Mesh& mesh_;
  const EdgeFlags& flags_;
};

}  // namespace

EdgeFlags flag_sharp_edges(Mesh& mesh, double angle, double spacing, std::size_t& dropped) {
  EdgeFlags sharp = mesh.add_property_map<Mesh::Edge_index, bool>("e:sharp", false).first;
  CGAL::Polygon_mesh_processing::detect_sharp_edges(mesh, angle * 180 / std::numbers::pi, sharp);
  dropped = drop_short_features(mesh, sharp, kShortestFeature * spacing);
  return sharp;
}

double flag_outline(Mesh& mesh, const std::vector<Edge>& outline, double spacing, EdgeFlags flags) {
  std::vector<Segment> flagged;
  for (const auto e : mesh.edges())
    if (flags[e]) flagged.push_back(segment_of(mesh, e));
  const auto vertex = [](std::int32_t v) { return Mesh::Vertex_index(static_cast<unsigned>(v)); };
  EdgeFlags follows = mesh.add_property_map<Mesh::Edge_index, bool>("e:outline", false).first;
  for (const Edge& ends : outline) {
    const auto edge = mesh.edge(mesh.halfedge(vertex(ends[0]), vertex(ends[1])));
    const Segment segment = segment_of(mesh, edge);
    follows[edge] = std::none_of(flagged.begin(), flagged.end(), [&](const Segment& other) {
      return runs_beside(segment, other, kBeside * spacing);
    });
  }
  drop_short_features(mesh, follows, kShortestFeature * spacing);
  double left_out = 0;
  for (const Edge& ends : outline) {
    const auto edge = mesh.edge(mesh.halfedge(vertex(ends[0]), vertex(ends[1])));
    if (follows[edge]) flags[edge] = true;
    if (!flags[edge]) left_out += length(mesh, edge);
  }
  mesh.remove_property_map(follows);
  return left_out;
}

VertexFlags flag_corners(Mesh& mesh, const std::vector<std::vector<Edge>>& outlines, double spacing,
                         const EdgeFlags& flags) {
  VertexFlags corners = mesh.add_property_map<Mesh::Vertex_index, bool>("v:corner", false).first;
  const FlaggedLines lines(mesh, flags);
  std::set<std::int32_t> along;
  for (const std::vector<Edge>& outline : outlines)
    for (const Edge& ends : outline) along.insert(ends.begin(), ends.end());
  std::vector<std::pair<double, Mesh::Vertex_index>> turns;  // cosines
  for (const std::int32_t point : along) {
    const Mesh::Vertex_index v(static_cast<unsigned>(point));
    const double cosine = lines.cosine_of_turn(v, kCornerReach * spacing);
    if (cosine < kCornerCosine) turns.emplace_back(cosine, v);
  }
  std::sort(turns.begin(), turns.end());
  std::vector<Vec3> taken;
  for (const auto& [cosine, v] : turns) {
    const Vec3 x = to_vec3(mesh.point(v));
    const bool has_room = std::none_of(taken.begin(), taken.end(), [&](const Vec3& other) {
      return norm(x - other) < kCornerReach * spacing;
    });
    if (!has_room) continue;
    corners[v] = true;
    taken.push_back(x);
  }
  return corners;
}

}  // namespace palpate::mesher
