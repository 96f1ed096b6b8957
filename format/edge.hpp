// SPDX-License-Identifier: Apache-2.0
// Edges of triangulations, which have no direction: the lower vertex comes first.
#pragma once

#include <algorithm>
#include <vector>

#include "format/vec3.hpp"

namespace palpate {

/// The edge between two vertices, whichever is named first.
constexpr Edge edge_between(std::int32_t a, std::int32_t b) {
  return a < b ? Edge{a, b} : Edge{b, a};
}

/// All edges of triangles, each once, ascending.
inline std::vector<Edge> edges_of(const std::vector<Triangle>& triangles) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const Triangle& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) edges.push_back(edge_between(t[i], t[(i + 1) % 3]));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace palpate
