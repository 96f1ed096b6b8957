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

/// The body on quadratic elements: first the nodes of the body, in its order, then the mid-edge
/// nodes; those of curved edges lie on the surface. Elements have straight edges; only the contact
/// and the refinement use the positions of mid-edge nodes. A mid-edge node is fixed when its edge
/// lies on a facet with three fixed corners or, with both ends, in a fixed volume.
struct QuadraticMesh {
  Eigen::Matrix3Xd X;  ///< (3, nodes) reference positions, m
  std::vector<Tetrahedron10> tetrahedra;
  std::vector<std::int32_t> region;        ///< of each tetrahedron
  std::vector<Facet> facets;               ///< boundary, outward
  std::vector<std::int32_t> facet_region;  ///< region of the tetrahedron behind each facet
  std::vector<bool> fixed;                 ///< (nodes) fixed by a support
  std::vector<SprungFacet> sprung;
  std::vector<std::array<std::int32_t, 2>> edges;  ///< the two corners of each mid-edge node
  /// Whether displacements are linear in each element: mid-edge nodes follow their corners.
  bool linear = false;

  int nodes() const { return static_cast<int>(X.cols()); }
  int corners() const { return nodes() - static_cast<int>(edges.size()); }
  /// Whether a node has unknowns: it is not fixed and does not follow its corners.
  bool is_free(int node) const { return !fixed[to_index(node)] && (!linear || node < corners()); }
};

QuadraticMesh make_quadratic_mesh(const Body& body, bool linear = false);

/// Volume of a tetrahedron of the mesh, m^3, and the mean of its corners, m.
double volume_of(const QuadraticMesh& mesh, int element);
Eigen::Vector3d centroid(const QuadraticMesh& mesh, int element);

/// If the mesh is linear, sets the displacements of mid-edge nodes halfway between their corners.
void straighten(const QuadraticMesh& mesh, Eigen::Matrix3Xd& u);

}  // namespace palpate::fem
