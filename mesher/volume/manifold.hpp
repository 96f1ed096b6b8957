// SPDX-License-Identifier: AGPL-3.0-or-later
// Takes the boundary of tetrahedra apart where it touches itself.
#pragma once

#include <cstdint>
#include <vector>

#include "format/edge.hpp"
#include "format/vec3.hpp"

namespace palpate::mesher {

/// What make_manifold did. Nothing is removed, and no node moves.
struct ManifoldChange {
  /// What each new node is made of: the ends of the edge that it halves, or twice the node that it
  /// is a copy of or lies beside. These nodes were there.
  std::vector<Edge> node_from;
  std::vector<std::int32_t> tetrahedron_from;  ///< for each new tetrahedron, one that was there
  std::size_t copies = 0;                      ///< new nodes at the places of others
  std::size_t halved_edges = 0;
  std::size_t filled_tips = 0;
};

/// Changes tetrahedra so that their boundary is a manifold.
///
/// - Tetrahedra that meet in a node or an edge alone get nodes of their own there (split_nodes).
/// - Where the tetrahedra at an edge of more than two facets are connected by faces around an end
///   of it, the edge is halved, and the middle becomes one node for each wedge.
/// - Where two voids meet in a node, the tip of one is filled by a new node and one tetrahedron
///   for each facet around it, no larger than a third of the shortest edge there.
///
/// New tetrahedra are appended; those that were there keep their places.
/// Where no tip can be filled, as no point sees all facets around it or something else of the
/// boundary lies there, the boundary still touches itself.
/// @pre the tetrahedra do not overlap.
ManifoldChange make_manifold(std::vector<Vec3>& nodes, std::vector<Tetrahedron>& tetrahedra);

}  // namespace palpate::mesher
