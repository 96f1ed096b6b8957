// SPDX-License-Identifier: AGPL-3.0-or-later
// From the unknowns of a mesh to those of the mesh with some elements refined, and back.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/mesh/refined_mesh.hpp"
#include "fem/solid/solid_model.hpp"

namespace palpate::fem {

/// The new unknowns of a refined mesh as functions of those of the unrefined one. Both numbered by
/// node, the old ones first.
class Prolongation {
 public:
  /// `whole`: the refined body, all nodes free that are not held. `elements`: of the unrefined
  /// mesh.
  Prolongation(const RefinedMesh& refined, const std::vector<Tetrahedron10>& elements,
               const SolidModel& whole);

  /// (d, P d): new nodes move as their parents would.
  Eigen::VectorXd extended(const Eigen::VectorXd& d) const;
  /// f_old + P^T f_new: the gradient over the old unknowns when new nodes follow.
  Eigen::VectorXd reduced(const Eigen::VectorXd& f) const;

 private:
  struct Share {
    int node;    ///< first of the three unknowns of a new node
    int parent;  ///< of one that it follows
    double N;
  };
  Eigen::Index old_ = 0, all_ = 0;  ///< unknowns
  std::vector<Share> shares_;
};

}  // namespace palpate::fem
