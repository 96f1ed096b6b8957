// SPDX-License-Identifier: AGPL-3.0-or-later
// Smaller elements where one site needs them, on a body that all sites share.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/mesh/quadratic_mesh.hpp"

namespace palpate::fem {

/// A mesh, some of its elements divided in eight: four at the corners, the octahedron between them
/// in four along its shortest diagonal [Bey 1995]. Their neighbours are divided as far as the mesh
/// has to fit together: along one edge, along two opposite ones, or along those of one face; in
/// eight where that is not enough. The nodes of the unrefined mesh come first, in its order. The
/// new ones are the middles of the new edges. All lie on the quadratic through the nodes of their
/// parents, so that the children of elements under a curved skin follow it.
struct RefinedMesh {
  /// Where a new node lies: its displacement, were the parent still one quadratic element, is
  /// sum N_a u_a over the nodes of the parent.
  struct NewNode {
    std::int32_t parent;  ///< element of the unrefined mesh
    std::array<double, kTetNodes> N;
  };

  QuadraticMesh mesh;  ///< unrefined elements in their order, then the children; without springs
  std::vector<NewNode> new_nodes;
};

/// `elements`: to be divided in eight. @throws Error(Geometry) where a curved edge turns a child
/// over.
RefinedMesh refine_elements(const QuadraticMesh& mesh, const std::vector<int>& elements);

}  // namespace palpate::fem
