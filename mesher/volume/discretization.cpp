// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/discretization.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "format/edge.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/skin/coarsen.hpp"

namespace palpate::mesher {
namespace {

/// Face k of a tetrahedron is opposite its corner k and oriented outward.
constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

[[noreturn]] void refuse_boundary(const std::string& where, const std::string& problem,
                                  const Vec3& place) {
  refuse_geometry(where, text(problem, " at ", millimetres(place)),
                  "separate the parts there, or join them over a face");
}

void check_edges(const std::vector<Triangle>& facets, const std::vector<Vec3>& nodes,
                 const std::string& where) {
  std::map<Edge, int> uses;
  for (const Triangle& t : facets)
    for (std::size_t k = 0; k < 3; ++k) ++uses[edge_between(t[k], t[(k + 1) % 3])];
  for (const auto& [edge, count] : uses)
    if (count != 2)
      refuse_boundary(where, "the surface of the tetrahedra meets itself in an edge",
                      0.5 * (nodes[to_index(edge[0])] + nodes[to_index(edge[1])]));
}

/// The facets around a node form one fan.
void check_nodes(const std::vector<Triangle>& facets, const std::vector<Vec3>& nodes,
                 const std::string& where) {
  const auto around = incident_triangles(nodes.size(), facets);
  for (std::size_t v = 0; v < nodes.size(); ++v) {
    if (around[v].empty()) continue;
    std::map<std::int32_t, std::int32_t> next;  // along the border of the fan
    for (const std::int32_t f : around[v]) {
      const Triangle& t = facets[to_index(f)];
      const auto k = static_cast<std::size_t>(
          std::find(t.begin(), t.end(), static_cast<std::int32_t>(v)) - t.begin());
      next[t[(k + 1) % 3]] = t[(k + 2) % 3];
    }
    const std::int32_t start = next.begin()->first;
    std::size_t length = 1;
    for (std::int32_t n = next.at(start); n != start && length <= next.size(); n = next.at(n))
      ++length;
    if (length != around[v].size())
      refuse_boundary(where, "the surface of the tetrahedra meets itself in a node", nodes[v]);
  }
}

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
  std::map<Triangle, std::pair<Triangle, int>> faces;
  for (const Tetrahedron& t : volume.tetrahedra)
    for (const auto& corners : kFaces) {
      const Triangle face{t[corners[0]], t[corners[1]], t[corners[2]]};
      auto& entry = faces[sorted(face)];
      entry.first = face;
      ++entry.second;
    }
  std::vector<Triangle> facets;
  for (const auto& [key, entry] : faces)
    if (entry.second == 1) facets.push_back(entry.first);
  check_edges(facets, volume.nodes, where);
  check_nodes(facets, volume.nodes, where);
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
