// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <vector>

#include "fem/solid/solid_model.hpp"

namespace palpate::fem {

/// Tells when a part of the surface enters another part of the body: contact of the body with
/// itself is not modelled, and what follows its onset means nothing.
class SelfContact {
 public:
  /// Watches what lies within `reach` of `centre` at rest.
  SelfContact(const QuadraticMesh& mesh, const Eigen::Vector3d& centre, double reach);

  /// A corner node of the boundary that lies inside a tetrahedron (its deformed corners) which is
  /// no neighbour of it, nor of a neighbour; -1 when there is none.
  int entering_node(const Displacement& u) const;

 private:
  struct Watched {
    int node;
    std::vector<int> ring;  ///< ascending: the node and all it shares a tetrahedron with
  };

  const QuadraticMesh* mesh_;
  std::vector<Watched> nodes_;
  std::vector<int> tetrahedra_;
};

}  // namespace palpate::fem
