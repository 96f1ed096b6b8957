// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/skin/remesh.hpp"

#include <CGAL/AABB_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>

#include <algorithm>
#include <set>
#include <utility>

#include "format/edge.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/cgal_mesh.hpp"
#include "mesher/geometry/queries.hpp"
#include "mesher/skin/features.hpp"

namespace palpate::mesher {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

using Segments = std::vector<Kernel::Segment_3>;
using SegmentTree = CGAL::AABB_tree<
    CGAL::AABB_traits<Kernel, CGAL::AABB_segment_primitive<Kernel, Segments::const_iterator>>>;

// The remeshing is repeated with the vertices put back on the input between the rounds, because
// relaxation lets vertices of a curved sharp edge drift along its chords.
constexpr unsigned kRemeshingRounds = 4;
constexpr unsigned kIterationsPerRound = 3;

// An edge that bulges less than this, in parts of its length, is straight: what is left is
// rounding.
constexpr double kLeastBulge = 1e-9;

/// The input surface and its sharp edges, onto which vertices are put.
class Target {
 public:
  Target(const Surface& input, const Mesh& mesh, EdgeFlags sharp) : surface_(input) {
    for (const auto e : mesh.edges()) {
      if (!sharp[e]) continue;
      const auto h = mesh.halfedge(e);
      segments_.emplace_back(mesh.point(mesh.source(h)), mesh.point(mesh.target(h)));
    }
    tree_.insert(segments_.begin(), segments_.end());
    if (!segments_.empty()) tree_.accelerate_distance_queries();
  }

  Vec3 on_surface(const Vec3& x) const { return surface_.closest(x).point; }
  Vec3 on_feature(const Vec3& x) const { return to_vec3(tree_.closest_point(to_point(x))); }

 private:
  SurfaceQuery surface_;
  Segments segments_;
  SegmentTree tree_;
};

void put_back(Mesh& mesh, EdgeFlags sharp, const VertexFlags& corners, const Target& target) {
  for (const auto v : mesh.vertices()) {
    if (corners[v]) continue;  // it was never moved
    std::size_t features = 0;
    for (const auto h : mesh.halfedges_around_target(mesh.halfedge(v))) {
      if (sharp[mesh.edge(h)]) ++features;
    }
    if (features == 1 || features > 2) continue;  // an end or a corner: it was never moved
    const Vec3 x = to_vec3(mesh.point(v));
    mesh.point(v) = to_point(features > 0 ? target.on_feature(x) : target.on_surface(x));
  }
}

/// Vertices on the straight edges and inside the triangles of the response surface, put on the
/// target, and the n x n facets between them.
class Subdivision {
 public:
  Subdivision(const Mesh& mesh, EdgeFlags sharp, const Target& target, int n)
      : mesh_(mesh), sharp_(std::move(sharp)), target_(target), n_(n) {
    result_.response = to_surface(mesh);
    result_.boundary.points = result_.response.points;
  }

  NestedSurface run() {
    for (const auto e : mesh_.edges()) split_edge(e);
    for (const auto f : mesh_.faces()) split_face(f);
    return std::move(result_);
  }

  /// The middles of the edges between the facets of run(), put on the target.
  std::vector<CurvedEdge> curved_edges(const Surface& boundary) const {
    std::vector<CurvedEdge> curved;
    for (const Edge& ends : edges_of(boundary.triangles)) {
      const Vec3 a = boundary.points[to_index(ends[0])];
      const Vec3 b = boundary.points[to_index(ends[1])];
      const Vec3 straight = 0.5 * (a + b);
      const Vec3 middle =
          sharp_edges_.contains(ends) ? target_.on_feature(straight) : target_.on_surface(straight);
      const double bulge = norm(middle - straight) / norm(b - a);
      if (bulge > kLeastBulge && bulge <= kMostBulge) curved.push_back({ends, middle});
    }
    return curved;
  }

 private:
  std::vector<Vec3>& points() { return result_.boundary.points; }

  std::int32_t add(const Vec3& x) {
    points().push_back(x);
    return static_cast<std::int32_t>(points().size() - 1);
  }

  /// An edge handed out by CGAL remembers the halfedge it came from; this one does not depend on
  /// it.
  Mesh::Halfedge_index first_halfedge(Mesh::Edge_index e) const { return mesh_.halfedge(e, 0); }

  void split_edge(Mesh::Edge_index e) {
    const auto h = first_halfedge(e);
    const Vec3 a = to_vec3(mesh_.point(mesh_.source(h)));
    const Vec3 b = to_vec3(mesh_.point(mesh_.target(h)));
    first_on_edge_.push_back(static_cast<std::int32_t>(points().size()));
    for (int k = 1; k < n_; ++k) {
      const Vec3 x = a + (static_cast<double>(k) / n_) * (b - a);
      add(sharp_[e] ? target_.on_feature(x) : target_.on_surface(x));
    }
    for (int k = 0; sharp_[e] && k < n_; ++k)
      sharp_edges_.insert(edge_between(on_halfedge(h, k), on_halfedge(h, k + 1)));
  }

  /// Point k of 0..n on the halfedge, counted from its source.
  std::int32_t on_halfedge(Mesh::Halfedge_index h, int k) const {
    if (k == 0) return static_cast<std::int32_t>(mesh_.source(h).idx());
    if (k == n_) return static_cast<std::int32_t>(mesh_.target(h).idx());
    const auto e = mesh_.edge(h);
    const int along = first_halfedge(e) == h ? k : n_ - k;
    return first_on_edge_[e.idx()] + along - 1;
  }

  /// Grid point a + (j/n)(b - a) + (i/n)(c - a) of the triangle abc, i + j <= n, i = row from ab.
  void split_face(Mesh::Face_index f) {
    const auto ab = mesh_.halfedge(f);
    const auto bc = mesh_.next(ab);
    const auto ca = mesh_.next(bc);
    const Vec3 a = to_vec3(mesh_.point(mesh_.source(ab)));
    const Vec3 b = to_vec3(mesh_.point(mesh_.source(bc)));
    const Vec3 c = to_vec3(mesh_.point(mesh_.source(ca)));
    std::vector<std::vector<std::int32_t>> row(to_index(n_) + 1);
    for (int i = 0; i <= n_; ++i) {
      for (int j = 0; i + j <= n_; ++j) {
        auto& points_of_row = row[to_index(i)];
        if (i == 0) {
          points_of_row.push_back(on_halfedge(ab, j));
        } else if (i + j == n_) {
          points_of_row.push_back(on_halfedge(bc, i));
        } else if (j == 0) {
          points_of_row.push_back(on_halfedge(ca, n_ - i));
        } else {
          const double s = static_cast<double>(j) / n_, t = static_cast<double>(i) / n_;
          points_of_row.push_back(add(target_.on_surface(a + s * (b - a) + t * (c - a))));
        }
      }
    }
    for (std::size_t i = 0; i + 1 < row.size(); ++i) {
      for (std::size_t j = 0; j < row[i + 1].size(); ++j) {
        add_facet({row[i][j], row[i][j + 1], row[i + 1][j]}, f);
        if (j + 1 < row[i + 1].size()) {
          add_facet({row[i][j + 1], row[i + 1][j + 1], row[i + 1][j]}, f);
        }
      }
    }
  }

  void add_facet(const Triangle& facet, Mesh::Face_index f) {
    result_.boundary.triangles.push_back(facet);
    result_.parent.push_back(static_cast<std::int32_t>(f.idx()));
  }

  const Mesh& mesh_;
  EdgeFlags sharp_;
  const Target& target_;
  int n_;
  std::vector<std::int32_t> first_on_edge_;
  std::set<Edge> sharp_edges_;  ///< of the boundary
  NestedSurface result_;
};

}  // namespace

void check_nesting(const NestedSurface& nested, double spacing, const std::string& where) {
  const std::string remedy =
      text("the detail of the surface is finer than a patch of ", millimetres(spacing),
           ": reduce the spacing or smooth the surface");
  std::size_t inverted = 0;
  for (std::size_t f = 0; f < nested.parent.size(); ++f) {
    const Triangle& patch = nested.response.triangles[to_index(nested.parent[f])];
    const Vec3 facet_normal = area_vector(nested.boundary.points, nested.boundary.triangles[f]);
    if (dot(facet_normal, area_vector(nested.response.points, patch)) <= 0) ++inverted;
  }
  if (inverted > 0) {
    throw Error(ErrorKind::Geometry, where,
                "remeshing inverted " + counted(inverted, "boundary facet"), remedy);
  }
  for (const Surface* surface : {&nested.response, &nested.boundary}) {
    if (const std::size_t pairs = count_self_intersections(*surface); pairs > 0) {
      throw Error(
          ErrorKind::Geometry, where,
          text("the remeshed surface self-intersects: ", counted(pairs, "pair"), " of triangles"),
          remedy);
    }
  }
}

NestedSurface remesh(const Surface& input, const RemeshSettings& settings, const std::string& where,
                     const Log& log) {
  Mesh mesh = to_mesh(input);
  std::size_t dropped = 0;
  const EdgeFlags sharp = flag_sharp_edges(mesh, settings.feature_angle, settings.spacing, dropped);
  if (dropped > 0) {
    note(log, text(where, ": ", counted(dropped, "sharp edge"), " in fragments shorter than ",
                   kShortestFeature, " patches are smoothed"));
  }
  double left_out = 0;
  for (const std::vector<Edge>& outline : settings.outlines)
    left_out += flag_outline(mesh, outline, settings.spacing, sharp);
  if (left_out > 0) {
    note(log, text("supports: ", millimetres(left_out),
                   " of their outlines run beside an edge or are shorter than ", kShortestFeature,
                   " patches: facets there end near them"));
  }
  const VertexFlags corners = flag_corners(mesh, settings.outlines, settings.spacing, sharp);
  const Target target(input, mesh, sharp);
  for (unsigned round = 0; round < kRemeshingRounds; ++round) {
    pmp::isotropic_remeshing(mesh.faces(), settings.spacing, mesh,
                             CGAL::parameters::edge_is_constrained_map(sharp)
                                 .vertex_is_constrained_map(corners)
                                 .number_of_iterations(kIterationsPerRound)
                                 .relax_constraints(true));
    put_back(mesh, sharp, corners, target);
  }
  mesh.collect_garbage();
  Subdivision subdivision(mesh, sharp, target, settings.subdivisions);
  NestedSurface nested = subdivision.run();
  if (settings.curved) nested.curved = subdivision.curved_edges(nested.boundary);
  check_nesting(nested, settings.spacing, where);
  return nested;
}

}  // namespace palpate::mesher
