// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "fem/mesh/tet10.hpp"
#include "format/body.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

/// A boundary facet with its mid-edge nodes: corners 0..2, then the edges 01, 12, 20.
using Facet = std::array<std::int32_t, 6>;

/// Nodes of an element: corners 0..3, then mid-edges as in kTetEdges.
using Tetrahedron10 = std::array<std::int32_t, kTetNodes>;

/// The body on quadratic elements: the nodes of the body come first, in its order, the mid-edge
/// nodes follow, those of curved edges on the skin. Elements have flat sides between their corners;
/// only a tool and the division of elements see where mid-edge nodes lie. A mid-edge node is held
/// when its edge lies on a held facet or in a held volume.
struct QuadraticMesh {
  Eigen::Matrix3Xd X;  ///< (3, nodes) reference positions, m
  std::vector<Tetrahedron10> tetrahedra;
  std::vector<std::int32_t> region;        ///< of each tetrahedron
  std::vector<Facet> facets;               ///< boundary, outward
  std::vector<std::int32_t> facet_region;  ///< region of the tetrahedron behind each facet
  std::vector<bool> fixed;                 ///< (nodes) by a support
  std::vector<SprungFacet> sprung;
  std::vector<std::array<std::int32_t, 2>> edges;  ///< the two corners of each mid-edge node
  /// Displacements are linear in each element: mid-edge nodes stay halfway between their corners.
  bool linear = false;

  int nodes() const { return static_cast<int>(X.cols()); }
  int corners() const { return nodes() - static_cast<int>(edges.size()); }
  /// Whether a node has displacements of its own: it is not held, nor does it follow its corners.
  bool is_free(int node) const { return !fixed[to_index(node)] && (!linear || node < corners()); }
};

QuadraticMesh make_quadratic_mesh(const Body& body, bool linear = false);

/// If the mesh is linear: mid-edge nodes to where they belong between their corners.
void straighten(const QuadraticMesh& mesh, Eigen::Matrix3Xd& u);

}  // namespace palpate::fem
