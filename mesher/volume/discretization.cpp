// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/discretization.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "format/edge.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/skin/coarsen.hpp"
#include "mesher/volume/boundary.hpp"

namespace palpate::mesher {
namespace {

/// Moves every node index of the mesh to its place in `order`.
void reorder(VolumeMesh& volume, const std::vector<std::int32_t>& order) {
  std::vector<std::int32_t> place(order.size());
  std::vector<Vec3> nodes;
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[to_index(order[i])] = static_cast<std::int32_t>(i);
    nodes.push_back(volume.nodes[to_index(order[i])]);
  }
  volume.nodes = std::move(nodes);
  for (Tetrahedron& t : volume.tetrahedra)
    for (std::int32_t& v : t) v = place[to_index(v)];
  for (CurvedEdge& e : volume.curved_edges)
    e.ends = edge_between(place[to_index(e.ends[0])], place[to_index(e.ends[1])]);
  std::sort(volume.curved_edges.begin(), volume.curved_edges.end(),
            [](const CurvedEdge& a, const CurvedEdge& b) { return a.ends < b.ends; });
  for (auto& [name, set] : volume.node_sets) {
    for (std::int32_t& v : set) v = place[to_index(v)];
    std::sort(set.begin(), set.end());
  }
}

/// The facets with their nodes alone, and the node of each point.
std::pair<Surface, std::vector<std::int32_t>> compact(const std::vector<Triangle>& facets,
                                                      const std::vector<Vec3>& nodes) {
  std::pair<Surface, std::vector<std::int32_t>> result;
  auto& [surface, node] = result;
  std::vector<std::int32_t> point(nodes.size(), -1);
  for (const Triangle& t : facets)
    for (const std::int32_t v : t) point[to_index(v)] = 0;
  for (std::size_t v = 0; v < nodes.size(); ++v) {
    if (point[v] < 0) continue;
    point[v] = static_cast<std::int32_t>(node.size());
    node.push_back(static_cast<std::int32_t>(v));
    surface.points.push_back(nodes[v]);
  }
  for (const Triangle& t : facets)
    surface.triangles.push_back(
        {point[to_index(t[0])], point[to_index(t[1])], point[to_index(t[2])]});
  return result;
}

CoarseSurface all_of(const Surface& fine) {
  CoarseSurface all{fine, std::vector<std::int32_t>(fine.points.size())};
  std::iota(all.fine_point.begin(), all.fine_point.end(), 0);
  return all;
}

/// Response vertices, other nodes of the boundary, interior nodes.
std::vector<std::int32_t> node_order(const CoarseSurface& coarse,
                                     const std::vector<std::int32_t>& node, std::size_t nodes) {
  std::vector<std::int32_t> order;
  std::vector<std::uint8_t> taken(nodes, 0);
  const auto take = [&](std::int32_t v) {
    if (std::exchange(taken[to_index(v)], std::uint8_t{1}) == 0) order.push_back(v);
  };
  for (const std::int32_t p : coarse.fine_point) take(node[to_index(p)]);
  for (const std::int32_t v : node) take(v);
  for (std::size_t v = 0; v < nodes; ++v) take(static_cast<std::int32_t>(v));
  return order;
}

}  // namespace

std::vector<Triangle> boundary_of(const VolumeMesh& volume, const std::string& where) {
  std::vector<Triangle> facets = adjacency(volume.tetrahedra).boundary;
  if (const Pinches found = pinches(facets); !found.nodes.empty()) {
    refuse_geometry(
        where,
        text("the surface of the tetrahedra meets itself in ", counted(found.edges.size(), "edge"),
             " and ", counted(found.points, "node"), ", the first at ",
             position_text(volume.nodes[to_index(found.nodes.front())])),
        "separate the parts there, or join them over a face");
  }
  // By their corners, so that the response surface does not depend on the order of the tetrahedra.
  const auto sorted = [](Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
  };
  std::sort(facets.begin(), facets.end(),
            [&](const Triangle& a, const Triangle& b) { return sorted(a) < sorted(b); });
  return facets;
}

Discretization with_response(VolumeMesh volume, double spacing, double feature_angle,
                             const std::string& where) {
  const auto [fine, node] = compact(boundary_of(volume, where), volume.nodes);
  CoarseSurface coarse = spacing > 0 ? coarsen(fine, spacing, feature_angle) : all_of(fine);
  reorder(volume, node_order(coarse, node, volume.nodes.size()));

  Discretization result;
  result.skin.response = std::move(coarse.surface);
  result.skin.boundary.points.assign(
      volume.nodes.begin(), volume.nodes.begin() + static_cast<std::ptrdiff_t>(node.size()));
  result.skin.boundary.triangles = boundary_of(volume, where);
  result.skin.curved = volume.curved_edges;
  result.volume = std::move(volume);
  return result;
}

}  // namespace palpate::mesher
