// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/skin/sharp_edges.hpp"

#include <cstddef>
#include <cstdint>

#include "format/edge.hpp"
#include "mesher/skin/features.hpp"

namespace palpate::mesher {

std::vector<Edge> sharp_edges(const Surface& surface, double angle, double spacing) {
  Mesh mesh = to_mesh(surface);
  std::size_t dropped = 0;
  const EdgeFlags sharp = flag_sharp_edges(mesh, angle, spacing, dropped);
  std::vector<Edge> edges;
  for (const Mesh::Edge_index edge : mesh.edges()) {
    if (!sharp[edge]) continue;
    const auto h = mesh.halfedge(edge);
    edges.push_back(edge_between(static_cast<std::int32_t>(mesh.source(h).idx()),
                                 static_cast<std::int32_t>(mesh.target(h).idx())));
  }
  return edges;
}

}  // namespace palpate::mesher
