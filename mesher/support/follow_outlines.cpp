// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/support/follow_outlines.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "format/edge.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/quality.hpp"
#include "mesher/geometry/queries.hpp"
#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {
namespace {

constexpr double kSmallestDihedral = 5, kLargestDihedral = 165;  ///< degrees
/// A farther node stays where it is: over the length of its edge across the outline.
constexpr double kFarthest = 0.75;
constexpr int kPasses = 3;
/// A node of one outline is on another, too, within this part of its edge.
constexpr double kSamePlace = 1e-6;
/// How much farther from the surface the middle of a facet may come by a move: by a factor, and by
/// a part of the longest edge. A node of a sharp edge that leaves it bends the flat faces beside
/// it.
constexpr double kBendFactor = 2.5, kMostBend = 0.01;

/// The mesh while its nodes move.
class Movable {
 public:
  Movable(const SurfaceQuery& surface, const std::vector<Triangle>& boundary,
          const std::vector<Tetrahedron>& tetrahedra, std::vector<Vec3>& nodes, std::size_t kept)
      : surface_(surface),
        boundary_(boundary),
        tetrahedra_(tetrahedra),
        nodes_(nodes),
        facets_(incident_triangles(nodes.size(), boundary)),
        around_(nodes.size()),
        pinned_(nodes.size(), false),
        kept_(kept) {
    std::fill_n(pinned_.begin(), kept, true);
    for (std::size_t t = 0; t < tetrahedra.size(); ++t)
      for (const std::int32_t v : tetrahedra[t]) around_[to_index(v)].push_back(t);
  }

  /// A node of one outline is not to leave it for another.
  void pin(std::int32_t v) { pinned_[to_index(v)] = true; }
  bool is_pinned(std::int32_t v) const { return pinned_[to_index(v)]; }

  const Vec3& at(std::int32_t v) const { return nodes_[to_index(v)]; }

  /// @return false when the tetrahedra around the node would be too flat, or the facets too far
  /// from the surface; it has not moved then.
  bool move(std::int32_t v, const Vec3& x) {
    if (to_index(v) < kept_) return true;  // it is there but for rounding
    const Quality before = quality_around(v);
    const std::vector<double> distances = distances_of_facets(v);
    const Vec3 from = std::exchange(nodes_[to_index(v)], x);
    const Quality after = quality_around(v);
    const bool sound =
        !inverts(v) && !bends(v, distances) &&
        after.smallest_dihedral >= std::min(kSmallestDihedral, before.smallest_dihedral) &&
        after.largest_dihedral <= std::max(kLargestDihedral, before.largest_dihedral);
    if (!sound) nodes_[to_index(v)] = from;
    return sound;
  }

 private:
  Quality quality_around(std::int32_t v) const {
    std::vector<Tetrahedron> own;
    for (const std::size_t t : around_[to_index(v)]) own.push_back(tetrahedra_[t]);
    return measure_quality(nodes_, own);
  }

  bool inverts(std::int32_t v) const {
    const auto& around = around_[to_index(v)];
    return std::any_of(around.begin(), around.end(),
                       [&](std::size_t t) { return !(volume(nodes_, tetrahedra_[t]) > 0); });
  }

  /// Those of the middles of the facets around a node from the surface.
  std::vector<double> distances_of_facets(std::int32_t v) const {
    std::vector<double> distances;
    for (const std::int32_t f : facets_[to_index(v)]) {
      const Triangle& t = boundary_[to_index(f)];
      const Vec3 middle = (1.0 / 3) * (at(t[0]) + at(t[1]) + at(t[2]));
      distances.push_back(norm(surface_.closest(middle).point - middle));
    }
    return distances;
  }

  /// Whether the facets around a node have left the surface, from these distances.
  bool bends(std::int32_t v, const std::vector<double>& before) const {
    const std::vector<double> now = distances_of_facets(v);
    const double allowed = kMostBend * longest_edge(v);
    return !std::equal(now.begin(), now.end(), before.begin(), [&](double after, double was) {
      return after <= kBendFactor * was + allowed;
    });
  }

  double longest_edge(std::int32_t v) const {
    double longest = 0;
    for (const std::int32_t f : facets_[to_index(v)])
      for (const std::int32_t corner : boundary_[to_index(f)])
        longest = std::max(longest, norm(at(corner) - at(v)));
    return longest;
  }

  const SurfaceQuery& surface_;
  const std::vector<Triangle>& boundary_;
  const std::vector<Tetrahedron>& tetrahedra_;
  std::vector<Vec3>& nodes_;
  std::vector<std::vector<std::int32_t>> facets_;
  std::vector<std::vector<std::size_t>> around_;
  std::vector<bool> pinned_;
  std::size_t kept_;
};

/// The outline of a part, and on which side of it nodes lie.
class Side {
 public:
  Side(const Surface& surface, const SurfaceQuery& query, const SupportedPart& part)
      : surface_(surface), query_(query), part_(part) {}

  bool is_inside(const Vec3& x) const { return part_.inside[to_index(query_.closest(x).triangle)]; }

  Vec3 nearest(const Vec3& x) const {
    Vec3 found{};
    double least = std::numeric_limits<double>::infinity();
    for (const Edge& e : part_.outline) {
      const Vec3 &a = surface_.points[to_index(e[0])], &b = surface_.points[to_index(e[1])];
      const double at = std::clamp(dot(x - a, b - a) / dot(b - a, b - a), 0.0, 1.0);
      const Vec3 foot = a + at * (b - a);
      const double distance = norm(x - foot);
      if (distance < least) std::tie(least, found) = std::tuple(distance, foot);
    }
    return found;
  }

 private:
  const Surface& surface_;
  const SurfaceQuery& query_;
  const SupportedPart& part_;
};

/// A way to end the crossing of an edge: one of its nodes moves.
struct Move {
  double distance;
  std::int32_t node;
  Vec3 to;
  std::size_t edge;  ///< of the crossing edges
};

enum class Place : unsigned char { Unknown, Inside, Outside, On };

/// The nodes of the edges of a mesh, which move onto the outline of a part.
class Follower {
 public:
  Follower(const Surface& surface, const SurfaceQuery& query, const SupportedPart& part,
           const std::vector<Edge>& edges, Movable& mesh, std::size_t nodes)
      : side_(surface, query, part), edges_(edges), mesh_(mesh), place_(nodes, Place::Unknown) {}

  void run() {
    find_crossing();
    // A node that could not move may have room when its neighbours have moved.
    for (int pass = 0; pass < kPasses && !crossing_.empty(); ++pass) {
      for (const Move& move : moves()) take(move);
      std::erase_if(crossing_, [&](const Edge& e) { return !crosses(e); });
    }
  }

  /// The number of edges that cross, wherever other outlines have moved their nodes since.
  std::size_t still_crossing() {
    find_crossing();
    return crossing_.size();
  }

 private:
  Place& place(std::int32_t v) { return place_[to_index(v)]; }
  Place place(std::int32_t v) const { return place_[to_index(v)]; }

  void find_crossing() {
    for (Place& known : place_)
      if (known != Place::On) known = Place::Unknown;
    for (const Edge& e : edges_)
      for (const std::int32_t v : e)
        if (Place& known = place(v); known == Place::Unknown)
          known = side_.is_inside(mesh_.at(v)) ? Place::Inside : Place::Outside;
    crossing_.clear();
    std::copy_if(edges_.begin(), edges_.end(), std::back_inserter(crossing_),
                 [&](const Edge& e) { return crosses(e); });
  }

  bool crosses(const Edge& e) const {
    const Place a = place(e[0]), b = place(e[1]);
    return a != b && a != Place::On && b != Place::On;
  }

  /// To the nearest point of the outline or to where the edge crosses it; shortest first.
  std::vector<Move> moves() const {
    std::vector<Move> found;
    for (std::size_t i = 0; i < crossing_.size(); ++i) {
      const Vec3 &a = mesh_.at(crossing_[i][0]), &b = mesh_.at(crossing_[i][1]);
      const Vec3 from_a = side_.nearest(a), from_b = side_.nearest(b);
      const double to_a = norm(from_a - a), both = to_a + norm(from_b - b);
      const Vec3 between = side_.nearest(a + (both > 0 ? to_a / both : 0.5) * (b - a));
      const auto add = [&](std::int32_t v, const Vec3& to) {
        const double distance = norm(to - mesh_.at(v));
        const double farthest = mesh_.is_pinned(v) ? kSamePlace : kFarthest;
        if (distance <= farthest * norm(b - a)) found.push_back({distance, v, to, i});
      };
      add(crossing_[i][0], from_a);
      add(crossing_[i][1], from_b);
      for (const std::int32_t v : crossing_[i]) add(v, between);
    }
    std::sort(found.begin(), found.end(), [](const Move& one, const Move& other) {
      return std::tie(one.distance, one.node, one.edge) <
             std::tie(other.distance, other.node, other.edge);
    });
    return found;
  }

  void take(const Move& move) {
    if (!crosses(crossing_[move.edge]) || !mesh_.move(move.node, move.to)) return;
    place(move.node) = Place::On;
    mesh_.pin(move.node);
  }

  Side side_;
  const std::vector<Edge>& edges_;
  Movable& mesh_;
  std::vector<Place> place_;
  std::vector<Edge> crossing_;
};

}  // namespace

std::size_t follow_outlines(const OutlinedSurface& outlined, const std::vector<Triangle>& boundary,
                            const std::vector<Tetrahedron>& tetrahedra, std::vector<Vec3>& nodes,
                            std::size_t kept) {
  const SurfaceQuery query(outlined.surface);
  const std::vector<Edge> edges = edges_of(boundary);
  Movable mesh(query, boundary, tetrahedra, nodes, kept);
  std::vector<Follower> followers;
  for (const SupportedPart& part : outlined.parts) {
    if (part.outline.empty()) continue;
    followers.emplace_back(outlined.surface, query, part, edges, mesh, nodes.size());
    followers.back().run();
  }
  return std::accumulate(followers.begin(), followers.end(), std::size_t{0},
                         [](std::size_t sum, Follower& f) { return sum + f.still_crossing(); });
}

}  // namespace palpate::mesher
