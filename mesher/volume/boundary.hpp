// SPDX-License-Identifier: AGPL-3.0-or-later
// How tetrahedra hang together: their common faces, their boundary, their parts.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "format/vec3.hpp"

namespace palpate::mesher {

struct Adjacency {
  std::vector<Triangle> boundary;  ///< faces of one tetrahedron, outward, in the order of those
  std::vector<std::int32_t> part;  ///< of each tetrahedron: equal where common faces lead
  std::int32_t parts = 0;
  /// A face of more than two tetrahedra, or of two on the same side of it: they overlap.
  std::optional<Triangle> overlap;
  std::size_t overlaps = 0;
};

/// @pre every tetrahedron has positive volume and four different corners.
Adjacency adjacency(const std::vector<Tetrahedron>& tetrahedra);

/// Where a closed, oriented surface is no manifold.
struct Pinches {
  std::size_t edges = 0;    ///< with more than two facets
  std::size_t points = 0;   ///< whose facets form several fans, ends of such edges aside
  std::int32_t first = -1;  ///< a point of the first of them
};
Pinches pinches(const std::vector<Triangle>& closed_surface);

/// The number of connected components of a manifold surface.
std::size_t components(const std::vector<Triangle>& surface);

}  // namespace palpate::mesher
