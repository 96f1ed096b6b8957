// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/mesh/sharp_edges.hpp"

#include <algorithm>
#include <map>

#include "format/edge.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

constexpr double kSharp = 0.70710678118654752;  ///< cosine of 45 degrees

Vec3 normal_of(const Body& body, const Triangle& t) {
  const Vec3& a = body.nodes[to_index(t[0])];
  const Vec3 n = cross(body.nodes[to_index(t[1])] - a, body.nodes[to_index(t[2])] - a);
  return 1 / norm(n) * n;
}

double distance_to(const std::array<Vec3, 2>& segment, const Vec3& x) {
  const Vec3 along = segment[1] - segment[0];
  const double part = dot(x - segment[0], along) / dot(along, along);
  return norm(x - segment[0] - std::clamp(part, 0.0, 1.0) * along);
}

}  // namespace

std::vector<std::array<Vec3, 2>> sharp_edges(const Body& body) {
  std::map<Edge, Vec3> first;  // normal of the facet that came first
  std::vector<std::array<Vec3, 2>> sharp;
  for (const Triangle& t : body.boundary) {
    const Vec3 normal = normal_of(body, t);
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge ends = edge_between(t[i], t[(i + 1) % 3]);
      const auto [other, is_new] = first.emplace(ends, normal);
      if (!is_new && dot(other->second, normal) < kSharp)
        sharp.push_back({body.nodes[to_index(ends[0])], body.nodes[to_index(ends[1])]});
    }
  }
  return sharp;
}

std::vector<bool> near_sharp_edges(const Body& body, double reach) {
  const auto edges = sharp_edges(body);
  std::vector<bool> near;
  for (const auto node : body.response.node) {
    const Vec3& x = body.nodes[to_index(node)];
    near.push_back(std::any_of(edges.begin(), edges.end(),
                               [&](const auto& edge) { return distance_to(edge, x) <= reach; }));
  }
  return near;
}

}  // namespace palpate::fem
