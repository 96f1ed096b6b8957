// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <vector>

#include "fem/solid/solid_model.hpp"

namespace palpate::fem {

/// Detects a part of the surface that enters another part of the body. Self-contact is not
/// modelled: results after its onset are meaningless.
class SelfContact {
 public:
  /// Checks nodes and elements within `reach` of `centre` at rest.
  SelfContact(const QuadraticMesh& mesh, const Eigen::Vector3d& centre, double reach);

  /// A corner node of the boundary inside a tetrahedron with straight edges between its deformed
  /// corners, where neither the node nor a neighbour is a corner of it; -1 when there is none.
  int entering_node(const Displacement& u) const;

 private:
  struct Watched {
    int node;
    std::vector<int> ring;  ///< ascending: the node and the corners of all its tetrahedra
  };

  const QuadraticMesh* mesh_;
  std::vector<Watched> nodes_;
  std::vector<int> tetrahedra_;
};

}  // namespace palpate::fem
