// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/mesh/quadratic_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <unordered_map>

#include "fem/mesh/to_eigen.hpp"
#include "format/edge.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

/// Numbers mid-edge nodes in the order in which their edges are first met.
class EdgeNodes {
 public:
  explicit EdgeNodes(std::int32_t first) : next_(first) {}

  std::int32_t of(std::int32_t a, std::int32_t b) {
    const Edge ends = edge_between(a, b);
    const std::uint64_t key =
        (static_cast<std::uint64_t>(ends[0]) << 32) | static_cast<std::uint32_t>(ends[1]);
    const auto [entry, added] = node_.try_emplace(key, next_);
    if (added) {
      ++next_;
      corners_.push_back(ends);
    }
    return entry->second;
  }

  const std::vector<Edge>& corners() const { return corners_; }

 private:
  std::int32_t next_;
  std::unordered_map<std::uint64_t, std::int32_t> node_;
  std::vector<Edge> corners_;
};

/// A mid-edge node is fixed with its edge: on a facet with three fixed corners, or where both ends
/// are fixed and at least one lies inside the body. The middle of an edge through the body from one
/// fixed face to another is free.
void mark_fixed_nodes(const Body& body, const EdgeNodes& edges, QuadraticMesh& mesh) {
  mesh.fixed.assign(to_index(mesh.nodes()), false);
  for (const auto node : body.fixed_nodes) mesh.fixed[to_index(node)] = true;
  std::vector<bool> on_boundary(body.nodes.size(), false);
  for (const Triangle& facet : body.boundary)
    for (const auto corner : facet) on_boundary[to_index(corner)] = true;
  const auto corner_count = body.nodes.size();
  for (std::size_t e = 0; e < edges.corners().size(); ++e) {
    const auto [a, b] = edges.corners()[e];
    const bool across = on_boundary[to_index(a)] && on_boundary[to_index(b)];
    mesh.fixed[corner_count + e] = mesh.fixed[to_index(a)] && mesh.fixed[to_index(b)] && !across;
  }
  for (const Facet& facet : mesh.facets)
    if (mesh.fixed[to_index(facet[0])] && mesh.fixed[to_index(facet[1])] &&
        mesh.fixed[to_index(facet[2])])
      for (std::size_t edge = 3; edge < 6; ++edge) mesh.fixed[to_index(facet[edge])] = true;
}

using Corners = std::array<std::int32_t, 3>;

Corners sorted(Corners corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

std::vector<std::int32_t> regions_behind(const Body& body) {
  std::map<Corners, std::size_t> facet_of;
  for (std::size_t f = 0; f < body.boundary.size(); ++f)
    facet_of.emplace(sorted(body.boundary[f]), f);
  std::vector<std::int32_t> region(body.boundary.size(), 0);
  for (std::size_t t = 0; t < body.tetrahedra.size(); ++t)
    for (std::size_t opposite = 0; opposite < 4; ++opposite) {
      Corners face{};
      for (std::size_t i = 0, c = 0; c < 4; ++c)
        if (c != opposite) face[i++] = body.tetrahedra[t][c];
      const auto found = facet_of.find(sorted(face));
      if (found != facet_of.end()) region[found->second] = body.tetrahedron_region[t];
    }
  return region;
}

}  // namespace

QuadraticMesh make_quadratic_mesh(const Body& body, bool linear) {
  QuadraticMesh mesh;
  mesh.linear = linear;
  EdgeNodes edges(static_cast<std::int32_t>(body.nodes.size()));
  mesh.region = body.tetrahedron_region;
  mesh.tetrahedra.reserve(body.tetrahedra.size());
  for (const auto& corners : body.tetrahedra) {
    Tetrahedron10 nodes{};
    std::copy(corners.begin(), corners.end(), nodes.begin());
    for (std::size_t e = 0; e < kTetEdges.size(); ++e)
      nodes[4 + e] = edges.of(corners[kTetEdges[e][0]], corners[kTetEdges[e][1]]);
    mesh.tetrahedra.push_back(nodes);
  }
  for (const auto& t : body.boundary)
    mesh.facets.push_back(
        {t[0], t[1], t[2], edges.of(t[0], t[1]), edges.of(t[1], t[2]), edges.of(t[2], t[0])});

  mesh.facet_region = regions_behind(body);
  mesh.sprung = body.foundation;

  const auto corner_count = static_cast<Eigen::Index>(body.nodes.size());
  mesh.X.resize(3, corner_count + static_cast<Eigen::Index>(edges.corners().size()));
  for (Eigen::Index i = 0; i < corner_count; ++i)
    mesh.X.col(i) = to_eigen(body.nodes[static_cast<std::size_t>(i)]);
  for (std::size_t e = 0; e < edges.corners().size(); ++e)
    mesh.X.col(corner_count + static_cast<Eigen::Index>(e)) =
        0.5 * (mesh.X.col(edges.corners()[e][0]) + mesh.X.col(edges.corners()[e][1]));
  for (const CurvedEdge& curved : body.curved_edges)
    mesh.X.col(edges.of(curved.ends[0], curved.ends[1])) = to_eigen(curved.middle);
  mark_fixed_nodes(body, edges, mesh);
  mesh.edges = edges.corners();
  return mesh;
}

double volume_of(const QuadraticMesh& mesh, int element) {
  const auto& node = mesh.tetrahedra[to_index(element)];
  const auto edge = [&](std::size_t c) -> Eigen::Vector3d {
    return mesh.X.col(node[c]) - mesh.X.col(node[0]);
  };
  return edge(1).cross(edge(2)).dot(edge(3)) / 6;
}

Eigen::Vector3d centroid(const QuadraticMesh& mesh, int element) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t c = 0; c < 4; ++c) sum += mesh.X.col(mesh.tetrahedra[to_index(element)][c]);
  return sum / 4;
}

void straighten(const QuadraticMesh& mesh, Eigen::Matrix3Xd& u) {
  if (!mesh.linear) return;
  Eigen::Index node = mesh.corners();
  for (const auto& [a, b] : mesh.edges) u.col(node++) = 0.5 * (u.col(a) + u.col(b));
}

}  // namespace palpate::fem
