// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/mesh/separate_sheets.hpp"

#include <algorithm>
#include <utility>

#include "format/to_index.hpp"
#include "mesher/volume/boundary.hpp"
#include "mesher/volume/manifold.hpp"

namespace palpate::mesher {
namespace {

bool is_middle(const Edge& from) {
  return from[0] != from[1];
}

/// The changed corners, and the new tetrahedra. Those with a new middle of an edge become linear.
void take_corners(MeshEntities& entities, const std::vector<Tetrahedron>& corners,
                  const ManifoldChange& change) {
  for (const std::int32_t from : change.tetrahedron_from) {
    ListedTetrahedron added = entities.tetrahedra[to_index(from)];
    added.quadratic = false;
    entities.tetrahedra.push_back(added);
  }
  const auto first_new = static_cast<std::int32_t>(entities.nodes.size() - change.node_from.size());
  for (std::size_t t = 0; t < corners.size(); ++t) {
    ListedTetrahedron& listed = entities.tetrahedra[t];
    for (std::size_t k = 0; k < 4; ++k) {
      const std::int32_t node = corners[t][k];
      if (node >= first_new && is_middle(change.node_from[to_index(node - first_new)]))
        listed.quadratic = false;
      listed.nodes[k] = node;
    }
  }
}

/// A new node is in the sets that have all nodes it is made of.
void extend_sets(MeshEntities& entities, const ManifoldChange& change) {
  const std::size_t first_new = entities.nodes.size() - change.node_from.size();
  for (auto& [name, nodes] : entities.node_sets) {
    std::vector<std::uint8_t> is_member(entities.nodes.size(), 0);
    for (const std::int32_t node : nodes) is_member[to_index(node)] = 1;
    for (std::size_t i = 0; i < change.node_from.size(); ++i) {
      const auto [a, b] = change.node_from[i];
      if (is_member[to_index(a)] == 0 || is_member[to_index(b)] == 0) continue;
      is_member[first_new + i] = 1;
      nodes.push_back(static_cast<std::int32_t>(first_new + i));
    }
  }
}

void tell(const MeshEntities& entities, const ManifoldChange& change, const std::string& where,
          const Log& log) {
  const Vec3& first = entities.nodes[entities.nodes.size() - change.node_from.size()];
  if (change.copies > 0) {
    const std::string halved =
        change.halved_edges == 0 ? "" : text(", ", counted(change.halved_edges, "edge"), " halved");
    note(log, text(where, ": elements that met only in a node or an edge are separated: ",
                   counted(change.copies, "node"), " added", halved, ", the first at ",
                   position_text(first), "; they transmit no force to each other there"));
  }
  if (change.filled_tips > 0) {
    note(log, text(where, ": the boundary touched itself in a node: filled the tip of ",
                   counted(change.filled_tips, "void"), " there, the last at ",
                   position_text(entities.nodes.back())));
  }
}

}  // namespace

void separate_sheets(MeshEntities& entities, const std::string& where, const Log& log) {
  std::vector<Tetrahedron> corners;
  for (const ListedTetrahedron& t : entities.tetrahedra)
    corners.push_back({t.nodes[0], t.nodes[1], t.nodes[2], t.nodes[3]});
  if (adjacency(corners).overlap) return;  // a fault of its own
  const ManifoldChange change = make_manifold(entities.nodes, corners);
  if (change.node_from.empty()) return;
  take_corners(entities, corners, change);
  for (const Edge& from : change.node_from)
    entities.node_numbers.push_back(std::int64_t(entities.node_numbers[to_index(from[0])]));
  extend_sets(entities, change);
  tell(entities, change, where, log);
}

}  // namespace palpate::mesher
