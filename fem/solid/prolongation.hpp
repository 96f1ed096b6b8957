// SPDX-License-Identifier: AGPL-3.0-or-later
// From the unknowns of a mesh to those of the mesh with some elements refined, and back.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/mesh/refined_mesh.hpp"
#include "fem/solid/solid_model.hpp"

namespace palpate::fem {

/// The unknowns of new nodes of a refined mesh as functions of the unknowns of the unrefined mesh.
/// Both are numbered by node, the unrefined ones first. Immutable after construction.
class Prolongation {
 public:
  /// `whole`: the refined body, all nodes free that are not fixed. `elements`: of the unrefined
  /// mesh.
  Prolongation(const RefinedMesh& refined, const std::vector<Tetrahedron10>& elements,
               const SolidModel& whole);

  /// (d, P d): new nodes move with their parent elements.
  Eigen::VectorXd extended(const Eigen::VectorXd& d) const;
  /// f_old + P^T f_new: the gradient by the old unknowns when new nodes follow them.
  Eigen::VectorXd reduced(const Eigen::VectorXd& f) const;

 private:
  struct Weight {
    int node;    ///< first of the three unknowns of a new node
    int parent;  ///< the same of a node of its parent element
    double N;
  };
  Eigen::Index old_ = 0, all_ = 0;  ///< unknowns
  std::vector<Weight> weights_;
};

}  // namespace palpate::fem
