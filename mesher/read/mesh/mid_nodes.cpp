// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/mesh/mid_nodes.hpp"

#include <algorithm>
#include <map>

#include "format/edge.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"

namespace palpate::mesher {
namespace {

/// A mid-node that is nearer to halfway, in parts of the length of its edge, does not curve it.
constexpr double kStraight = 1e-4;

struct MidNode {
  Vec3 middle{};
  std::int64_t element = 0;  ///< a tetrahedron that has it, by its number in the file
};

std::map<Edge, MidNode> mid_nodes(const MeshEntities& entities, const std::string& where) {
  std::map<Edge, MidNode> found;
  for (const ListedTetrahedron& t : entities.tetrahedra) {
    if (!t.quadratic) continue;
    for (std::size_t k = 0; k < kTetrahedronEdges.size(); ++k) {
      const auto [a, b] = kTetrahedronEdges[k];
      const Edge ends = edge_between(t.nodes[a], t.nodes[b]);
      const Vec3& middle = entities.nodes[to_index(t.nodes[4 + k])];
      const auto [entry, is_new] = found.try_emplace(ends, MidNode{middle, t.number});
      const double length =
          norm(entities.nodes[to_index(ends[0])] - entities.nodes[to_index(ends[1])]);
      if (is_new || norm(entry->second.middle - middle) <= kStraight * length) continue;
      refuse_geometry(
          where,
          text("tetrahedra ", entry->second.element, " and ", t.number,
               " have different mid-nodes on their common edge at ", position_text(middle)),
          "merge the nodes of the parts, or export a linear mesh");
    }
  }
  return found;
}

/// The largest deviations from halfway of the edges inside the body.
struct Straightened {
  std::size_t count = 0;
  double largest = 0;  ///< in parts of the length of the edge
  Vec3 at{};
};

void report(const Straightened& inside, const std::string& where, const Log& log) {
  if (inside.count == 0) return;
  note(log, text(where, ": ", counted(inside.count, "edge"),
                 " inside the body curved in the file, by at most ", inside.largest,
                 " of its length, at ", position_text(inside.at),
                 ": only edges of the boundary stay curved"));
}

}  // namespace

std::vector<CurvedEdge> curved_boundary_edges(const MeshEntities& entities,
                                              const std::vector<Triangle>& boundary,
                                              const std::string& where, const Log& log) {
  const std::vector<Edge> on_boundary = edges_of(boundary);
  std::vector<CurvedEdge> curved;
  Straightened inside;
  for (const auto& [ends, mid] : mid_nodes(entities, where)) {
    const Vec3& a = entities.nodes[to_index(ends[0])];
    const Vec3& b = entities.nodes[to_index(ends[1])];
    const double bulge = norm(mid.middle - 0.5 * (a + b)) / norm(b - a);
    if (bulge <= kStraight) continue;
    if (!std::binary_search(on_boundary.begin(), on_boundary.end(), ends)) {
      ++inside.count;
      if (bulge > inside.largest) inside = {inside.count, bulge, mid.middle};
      continue;
    }
    if (!(bulge <= kMostBulge)) {
      refuse_geometry(where,
                      text("the mid-node of an edge of tetrahedron ", mid.element, " lies ", bulge,
                           " of the length of the edge from halfway, at ",
                           position_text(mid.middle), ", more than ", kMostBulge),
                      "refine the mesh there, or export a linear mesh");
    }
    curved.push_back({ends, mid.middle});
  }
  report(inside, where, log);
  return curved;
}

}  // namespace palpate::mesher
