// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "fem/tet10.hpp"
#include "format/body.hpp"

namespace palpate::fem {

/// A boundary facet with its mid-edge nodes: corners 0..2, then the edges 01, 12, 20.
using Facet = std::array<std::int32_t, 6>;

/// Nodes of an element: corners 0..3, then mid-edges as in kTetEdges.
using Tetrahedron10 = std::array<std::int32_t, kTetNodes>;

/// The body on quadratic elements: the nodes of the body come first, in its order, the mid-edge
/// nodes follow. A mid-edge node is held when both its corners are.
struct QuadraticMesh {
  Eigen::Matrix3Xd X;  ///< (3, nodes) reference positions, m
  std::vector<Tetrahedron10> tetrahedra;
  std::vector<std::int32_t> region;        ///< of each tetrahedron
  std::vector<Facet> facets;               ///< boundary, outward
  std::vector<std::int32_t> facet_region;  ///< region of the tetrahedron behind each facet
  std::vector<bool> held;                  ///< (nodes) by a support
  std::vector<SprungFacet> sprung;

  int nodes() const { return static_cast<int>(X.cols()); }
};

QuadraticMesh make_quadratic_mesh(const Body& body);

}  // namespace palpate::fem
