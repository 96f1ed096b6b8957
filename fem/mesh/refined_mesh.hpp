// SPDX-License-Identifier: AGPL-3.0-or-later
// Smaller elements where one site needs them, on a body that all sites share.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "fem/mesh/quadratic_mesh.hpp"

namespace palpate::fem {

/// A mesh with some elements divided into eight, once or more often: four at the corners, and the
/// octahedron between them into four along its shortest diagonal [Bey 1995]. Neighbours are divided
/// as conformity requires: along one edge, along two opposite edges, or along the edges of one
/// face; else, and where half of an edge is divided, into eight. Only elements divided into eight
/// have children that are divided again, so that the shape of elements does not degenerate with the
/// levels. The nodes of the unrefined mesh come first, in its order; the new ones are the middles
/// of the new edges. They lie on the quadratic through the nodes of their element of the unrefined
/// mesh, so that the children of elements at a curved surface follow it.
struct RefinedMesh {
  /// A new node; in its element of the unrefined mesh its position is sum N_a X_a, and its
  /// displacement, as long as that deforms as one quadratic element, sum N_a u_a.
  struct NewNode {
    std::int32_t parent;  ///< element of the unrefined mesh
    std::array<double, kTetNodes> N;
  };

  QuadraticMesh mesh;  ///< unrefined elements in their order, then the children
  std::vector<NewNode> new_nodes;
  std::vector<std::int32_t> parent;  ///< of each element, that of the unrefined mesh
};

/// Whether an element that has been divided into eight `level` times is to be divided again.
using ElementChoice = std::function<bool(const std::array<Eigen::Vector3d, 4>& corners, int level)>;

/// `elements`: to be divided into eight; then, up to the number of `levels`, those children that
/// `choose` asks for. @throws Error(Geometry) where a curved edge inverts a child.
RefinedMesh refine_elements(const QuadraticMesh& mesh, const std::vector<int>& elements,
                            int levels = 1, const ElementChoice& choose = {});

}  // namespace palpate::fem
