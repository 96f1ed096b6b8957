// SPDX-License-Identifier: AGPL-3.0-or-later
// How tetrahedra hang together: their common faces, their boundary, their parts.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "format/edge.hpp"
#include "format/vec3.hpp"

namespace palpate::mesher {

/// A face between two tetrahedra.
struct SharedFace {
  Triangle corners{};  ///< ascending
  std::array<std::int32_t, 2> tetrahedra{};
};

struct Adjacency {
  std::vector<Triangle> boundary;  ///< faces of one tetrahedron, outward, in the order of those
  std::vector<SharedFace> shared;  ///< ascending
  /// The part of each tetrahedron: equal where common faces lead; numbered by first tetrahedra.
  std::vector<std::int32_t> part;
  std::int32_t parts = 0;
  /// A face of more than two tetrahedra, or of two on the same side of it: they overlap.
  std::optional<Triangle> overlap;
  std::size_t overlaps = 0;
};

/// @pre every tetrahedron has positive volume and four different corners.
Adjacency adjacency(const std::vector<Tetrahedron>& tetrahedra);

/// Where a closed, oriented surface is no manifold.
struct Pinches {
  std::vector<Edge> edges;          ///< with more than two facets, ascending
  std::size_t points = 0;           ///< whose facets form several fans, ends of such edges aside
  std::vector<std::int32_t> nodes;  ///< these points and the ends of these edges, ascending
};
Pinches pinches(const std::vector<Triangle>& closed_surface);

/// Gives each set of tetrahedra that are connected by faces at a node a node of its own, so that
/// parts of a body that touch in a node or an edge come apart. Where a chain of such faces leads
/// around, the boundary still touches itself.
/// @param nodes their number; new ones are numbered from there on
/// @return of each new node, the node at whose place it is
std::vector<std::int32_t> split_nodes(std::vector<Tetrahedron>& tetrahedra, std::size_t nodes);

/// The number of connected components of a manifold surface.
std::size_t components(const std::vector<Triangle>& surface);

}  // namespace palpate::mesher
