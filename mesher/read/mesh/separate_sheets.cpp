// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/mesh/separate_sheets.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "format/edge.hpp"
#include "format/to_index.hpp"

namespace palpate::mesher {
namespace {

using Members = std::vector<std::int32_t>;  ///< indices of tetrahedra

std::vector<Members> tetrahedra_of_nodes(const MeshEntities& entities) {
  std::vector<Members> around(entities.nodes.size());
  for (std::size_t t = 0; t < entities.tetrahedra.size(); ++t)
    for (std::size_t k = 0; k < 4; ++k)
      around[to_index(entities.tetrahedra[t].nodes[k])].push_back(static_cast<std::int32_t>(t));
  return around;
}

/// The tetrahedra around a node in groups that common faces with this node join, in the order of
/// their first members.
std::vector<Members> groups_around(const MeshEntities& entities, std::int32_t node,
                                   const Members& around) {
  // A face with the node is known by its other two corners.
  std::map<Edge, Members> faces;
  for (std::size_t i = 0; i < around.size(); ++i) {
    const auto& corners = entities.tetrahedra[to_index(around[i])].nodes;
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = a + 1; b < 4; ++b)
        if (corners[a] != node && corners[b] != node)
          faces[edge_between(corners[a], corners[b])].push_back(static_cast<std::int32_t>(i));
  }
  std::vector<std::int32_t> group(around.size());
  for (std::size_t i = 0; i < group.size(); ++i) group[i] = static_cast<std::int32_t>(i);
  const auto root = [&](std::int32_t i) {
    while (group[to_index(i)] != i) i = group[to_index(i)];
    return i;
  };
  for (const auto& [face, sides] : faces)
    for (const std::int32_t side : sides) {
      const std::int32_t a = root(sides.front()), b = root(side);
      group[to_index(std::max(a, b))] = std::min(a, b);
    }
  std::map<std::int32_t, Members> joined;
  for (std::size_t i = 0; i < around.size(); ++i)
    joined[root(static_cast<std::int32_t>(i))].push_back(around[i]);
  std::vector<Members> groups;
  for (auto& [first, members] : joined) groups.push_back(std::move(members));
  return groups;
}

/// A node at the place of `node`, for these tetrahedra.
std::int32_t copy_node(MeshEntities& entities, std::int32_t node, const Members& members) {
  const auto copy = static_cast<std::int32_t>(entities.nodes.size());
  entities.nodes.push_back(Vec3(entities.nodes[to_index(node)]));
  entities.node_numbers.push_back(std::int64_t(entities.node_numbers[to_index(node)]));
  for (const std::int32_t t : members) {
    auto& corners = entities.tetrahedra[to_index(t)].nodes;
    std::replace(corners.begin(), corners.begin() + 4, node, copy);
  }
  return copy;
}

/// Each set that has the node has its copies, too.
void copy_membership(MeshEntities& entities,
                     const std::map<std::int32_t, std::vector<std::int32_t>>& copies) {
  for (auto& [name, nodes] : entities.node_sets) {
    std::vector<std::int32_t> more;
    for (const std::int32_t node : nodes)
      if (const auto found = copies.find(node); found != copies.end())
        more.insert(more.end(), found->second.begin(), found->second.end());
    nodes.insert(nodes.end(), more.begin(), more.end());
  }
}

}  // namespace

void separate_sheets(MeshEntities& entities, const std::string& where, const Log& log) {
  const std::vector<Members> around = tetrahedra_of_nodes(entities);
  std::map<std::int32_t, std::vector<std::int32_t>> copies;
  for (std::size_t n = 0; n < around.size(); ++n) {
    const auto node = static_cast<std::int32_t>(n);
    const std::vector<Members> groups = groups_around(entities, node, around[n]);
    for (std::size_t g = 1; g < groups.size(); ++g)
      copies[node].push_back(copy_node(entities, node, groups[g]));
  }
  if (copies.empty()) return;
  copy_membership(entities, copies);
  note(log, text(where, ": elements that met only in a node or an edge are separated at ",
                 counted(copies.size(), "node"), ", the first at ",
                 millimetres(entities.nodes[to_index(copies.begin()->first)]),
                 ": they no longer hold each other there"));
}

}  // namespace palpate::mesher
