// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/skin/coarsen.hpp"

#include <CGAL/Polygon_mesh_processing/compute_normal.h>
#include <CGAL/Surface_mesh_simplification/Edge_collapse_visitor_base.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Edge_length_cost.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/boost/graph/Euler_operations.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "format/to_index.hpp"
#include "mesher/geometry/cgal_mesh.hpp"
#include "mesher/skin/features.hpp"

namespace palpate::mesher {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
namespace sms = CGAL::Surface_mesh_simplification;

using Vertex = Mesh::Vertex_index;
using Vector = Kernel::Vector_3;
using Corners = std::array<Point, 3>;

// Shortest-first collapses to edges of at least l leave edges of l to 2.5 l, 1.5 l in the mean.
constexpr double kShortestEdge = 0.65;
constexpr double kLongestEdge = 1.6;
// Least cosine of a triangle with the fine normals at its corners; at the corner of a box it is
// 0.58.
constexpr double kLeastCosineOfFold = 0.4;
// 1 for an equilateral triangle, 0 for a degenerate one.
constexpr double kLeastShape = 0.35;
constexpr int kSweepsOfFlips = 10;
constexpr int kCoarseningRounds = 3;

enum class Rank : unsigned char { Smooth, Crease, Corner };

/// 4 sqrt(3) area over the sum of the squared edges.
double shape(const Corners& x) {
  const double area =
      0.5 * std::sqrt(CGAL::cross_product(x[1] - x[0], x[2] - x[0]).squared_length());
  const double edges = CGAL::squared_distance(x[0], x[1]) + CGAL::squared_distance(x[1], x[2]) +
                       CGAL::squared_distance(x[2], x[0]);
  return edges > 0 ? 4 * std::numbers::sqrt3 * area / edges : 0;
}

Vector normal_of(const Corners& x) {
  const Vector n = CGAL::cross_product(x[1] - x[0], x[2] - x[0]);
  const double length = std::sqrt(n.squared_length());
  return length > 0 ? n / length : Vector(0, 0, 0);
}

/// The mesh while it is coarsened, and what is known of its points on the fine surface.
class Coarsening {
 public:
  Coarsening(const Surface& fine, double spacing, double feature_angle)
      : mesh_(to_mesh(fine)),
        spacing_(spacing),
        crease_cosine_(std::cos(feature_angle)),
        fine_(mesh_.add_property_map<Vertex, std::int32_t>("v:fine", -1).first) {
    for (const Vertex v : mesh_.vertices()) fine_[v] = static_cast<std::int32_t>(v.idx());
    auto normals = mesh_.add_property_map<Vertex, Vector>("v:normal", Vector(0, 0, 0)).first;
    pmp::compute_vertex_normals(mesh_, normals);
    for (const Vertex v : mesh_.vertices()) normal_.push_back(normals[v]);
    mesh_.remove_property_map(normals);
    set_ranks(feature_angle);
  }

  CoarseSurface run() {
    for (int round = 0; round < kCoarseningRounds; ++round) {
      collapse();
      flip();
    }
    mesh_.collect_garbage();
    CoarseSurface coarse;
    coarse.surface = to_surface(mesh_);
    for (const Vertex v : mesh_.vertices()) coarse.fine_point.push_back(fine_[v]);
    return coarse;
  }

 private:
  void set_ranks(double feature_angle) {
    std::size_t dropped = 0;
    EdgeFlags sharp = flag_sharp_edges(mesh_, feature_angle, spacing_, dropped);
    for (const Vertex v : mesh_.vertices()) {
      std::size_t creases = 0;
      for (const auto h : mesh_.halfedges_around_target(mesh_.halfedge(v)))
        creases += sharp[mesh_.edge(h)] ? 1 : 0;
      rank_.push_back(creases == 0 ? Rank::Smooth : creases == 2 ? Rank::Crease : Rank::Corner);
    }
    mesh_.remove_property_map(sharp);
  }

  Rank rank(Vertex v) const { return rank_[to_index(fine_[v])]; }

  Corners corners(Mesh::Face_index f) const {
    Corners x;
    std::size_t k = 0;
    for (const Vertex v : mesh_.vertices_around_face(mesh_.halfedge(f))) x[k++] = mesh_.point(v);
    return x;
  }

  bool is_crease(Mesh::Halfedge_index h) const {
    const Vector a = normal_of(corners(mesh_.face(h)));
    const Vector b = normal_of(corners(mesh_.face(mesh_.opposite(h))));
    return a * b < crease_cosine_;
  }

  /// A point leaves a smooth place in any direction, a crease along it, a corner never.
  bool may_leave(Vertex v, Mesh::Halfedge_index along) const {
    if (rank(v) == Rank::Corner) return false;
    if (rank(v) == Rank::Smooth) return true;
    return rank(mesh_.source(along)) != Rank::Smooth && rank(mesh_.target(along)) != Rank::Smooth &&
           is_crease(along);
  }

  /// Least cosine of the triangle with the fine normals at its corners.
  double least_cosine(const std::array<Vertex, 3>& v) const {
    const Vector n = normal_of({mesh_.point(v[0]), mesh_.point(v[1]), mesh_.point(v[2])});
    double least = 1;
    for (const Vertex corner : v) least = std::min(least, n * normal_[to_index(fine_[corner])]);
    return least;
  }

  double shape_of(const std::array<Vertex, 3>& v) const {
    return shape({mesh_.point(v[0]), mesh_.point(v[1]), mesh_.point(v[2])});
  }

  /// The least shape of the triangles around `from` when it moves to `to`; none where one of them
  /// turns away from the surface, flattens or has an edge that is too long.
  std::optional<double> shape_after(Vertex from, Vertex to) const {
    double least = 1;
    for (const auto h : mesh_.halfedges_around_target(mesh_.halfedge(from))) {
      const std::array<Vertex, 3> now{from, mesh_.target(mesh_.next(h)), mesh_.source(h)};
      if (now[1] == to || now[2] == to) continue;
      const std::array<Vertex, 3> then{to, now[1], now[2]};
      const double after = shape_of(then);
      if (after < std::min(kLeastShape, shape_of(now))) return std::nullopt;
      if (least_cosine(then) < std::min(kLeastCosineOfFold, least_cosine(now))) return std::nullopt;
      const double longest = kLongestEdge * spacing_;
      if (CGAL::squared_distance(mesh_.point(to), mesh_.point(now[1])) > longest * longest)
        return std::nullopt;
      least = std::min(least, after);
    }
    return least;
  }

  /// Half-edge collapse to the end that leaves the better triangles.
  struct KeepOneEnd {
    template <typename Profile>
    boost::optional<Point> operator()(const Profile& profile) const {
      const auto h = profile.v0_v1();
      const Vertex a = profile.v0(), b = profile.v1();
      std::optional<double> to_b, to_a;
      if (coarsening->may_leave(a, h)) to_b = coarsening->shape_after(a, b);
      if (coarsening->may_leave(b, h)) to_a = coarsening->shape_after(b, a);
      if (!to_a && !to_b) return boost::none;
      return to_b.value_or(-1) >= to_a.value_or(-1) ? profile.p1() : profile.p0();
    }
    const Coarsening* coarsening;
  };

  /// Hands the fine point on: CGAL keeps the second vertex, whichever point it gets.
  struct HandOn : sms::Edge_collapse_visitor_base<Mesh> {
    explicit HandOn(Coarsening& c) : coarsening(&c) {}
    void OnCollapsing(const Profile& profile, const boost::optional<Point>& placement) {
      if (!placement) return;
      kept = coarsening->fine_[*placement == profile.p0() ? profile.v0() : profile.v1()];
    }
    void OnCollapsed(const Profile&, const Vertex& v) { coarsening->fine_[v] = kept; }
    Coarsening* coarsening;
    std::int32_t kept = -1;
  };

  struct LongEnough {
    template <typename Profile>
    bool operator()(double cost, const Profile&, std::size_t, std::size_t) const {
      return cost > squared;
    }
    double squared;
  };

  void collapse() {
    const double shortest = kShortestEdge * spacing_;
    sms::edge_collapse(mesh_, LongEnough{shortest * shortest},
                       CGAL::parameters::get_cost(sms::Edge_length_cost<Mesh>())
                           .get_placement(KeepOneEnd{this})
                           .visitor(HandOn(*this)));
    mesh_.collect_garbage();
  }

  /// Flips edges where the worse of the two triangles becomes better.
  void flip() {
    for (int sweep = 0; sweep < kSweepsOfFlips; ++sweep) {
      std::size_t flipped = 0;
      for (const auto e : mesh_.edges()) flipped += flip(mesh_.halfedge(e)) ? 1 : 0;
      if (flipped == 0) return;
    }
  }

  bool flip(Mesh::Halfedge_index h) {
    const auto o = mesh_.opposite(h);
    const Vertex a = mesh_.source(h), b = mesh_.target(h);
    const Vertex c = mesh_.target(mesh_.next(h)), d = mesh_.target(mesh_.next(o));
    if (c == d || mesh_.halfedge(c, d).is_valid() || is_crease(h)) return false;
    if (mesh_.degree(a) <= 3 || mesh_.degree(b) <= 3) return false;
    const double longest = kLongestEdge * spacing_;
    if (CGAL::squared_distance(mesh_.point(c), mesh_.point(d)) > longest * longest) return false;
    const std::array<Vertex, 3> left{a, b, c}, right{b, a, d}, top{c, d, b}, bottom{d, c, a};
    const double before = std::min(shape_of(left), shape_of(right));
    if (std::min(shape_of(top), shape_of(bottom)) <= 1.01 * before) return false;
    const double turned = std::min(least_cosine(left), least_cosine(right));
    if (std::min(least_cosine(top), least_cosine(bottom)) < std::min(kLeastCosineOfFold, turned))
      return false;
    CGAL::Euler::flip_edge(h, mesh_);
    return true;
  }

  Mesh mesh_;
  double spacing_, crease_cosine_;
  Mesh::Property_map<Vertex, std::int32_t> fine_;
  std::vector<Vector> normal_;  ///< of the fine points
  std::vector<Rank> rank_;      ///< of the fine points
};

}  // namespace

CoarseSurface coarsen(const Surface& fine, double spacing, double feature_angle) {
  return Coarsening(fine, spacing, feature_angle).run();
}

}  // namespace palpate::mesher
