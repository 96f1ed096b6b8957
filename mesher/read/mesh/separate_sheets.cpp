// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/mesh/separate_sheets.hpp"

#include <algorithm>
#include <utility>

#include "format/to_index.hpp"
#include "mesher/volume/boundary.hpp"

namespace palpate::mesher {
namespace {

using Copies = std::vector<std::pair<std::int32_t, std::int32_t>>;  ///< node and copy, ascending

/// Each set that has a node has its copies, too.
void copy_membership(MeshEntities& entities, const Copies& copies) {
  for (auto& [name, nodes] : entities.node_sets) {
    std::vector<std::int32_t> more;
    for (const std::int32_t node : nodes) {
      auto copy = std::lower_bound(copies.begin(), copies.end(), std::pair(node, 0));
      for (; copy != copies.end() && copy->first == node; ++copy) more.push_back(copy->second);
    }
    nodes.insert(nodes.end(), more.begin(), more.end());
  }
}

}  // namespace

void separate_sheets(MeshEntities& entities, const std::string& where, const Log& log) {
  std::vector<Tetrahedron> corners;
  for (const ListedTetrahedron& t : entities.tetrahedra)
    corners.push_back({t.nodes[0], t.nodes[1], t.nodes[2], t.nodes[3]});
  const std::vector<std::int32_t> origin = split_nodes(corners, entities.nodes.size());
  if (origin.empty()) return;
  for (std::size_t t = 0; t < corners.size(); ++t)
    std::copy(corners[t].begin(), corners[t].end(), entities.tetrahedra[t].nodes.begin());
  Copies copies;
  for (const std::int32_t node : origin) {
    copies.emplace_back(node, static_cast<std::int32_t>(entities.nodes.size()));
    entities.nodes.push_back(Vec3(entities.nodes[to_index(node)]));
    entities.node_numbers.push_back(std::int64_t(entities.node_numbers[to_index(node)]));
  }
  copy_membership(entities, copies);
  note(log, text(where, ": elements that met only in a node or an edge are separated: ",
                 counted(copies.size(), "node"), " added, the first at ",
                 millimetres(entities.nodes[to_index(origin.front())]),
                 "; they transmit no force to each other there"));
}

}  // namespace palpate::mesher
