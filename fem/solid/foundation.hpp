// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/factor/sparse_pattern.hpp"
#include "fem/mesh/quadratic_mesh.hpp"

namespace palpate::fem {

/// Springs per area between the boundary and the ground [Winkler 1867], slack at rest. With N the
/// outward normal of a facet at rest and u the displacement, a facet stores
///   integral of (k_n (u . N)^2 + k_t |u - (u . N) N|^2)/2 over its area at rest:
/// a linear support that also resists tension. Immutable after construction.
class Foundation {
 public:
  Foundation() = default;
  /// The sprung facets with a node that is free (`equation` not negative).
  Foundation(const QuadraticMesh& mesh, const std::vector<int>& equation);

  double energy(const Eigen::Matrix3Xd& u) const;  ///< J
  /// f += d(energy)/du on the unknowns.
  void add_forces(const std::vector<int>& equation, const Eigen::Matrix3Xd& u,
                  Eigen::VectorXd& f) const;
  /// values += d2(energy)/du2, constant.
  void add_stiffness(const std::vector<int>& equation, const SparsePattern& pattern,
                     std::vector<double>& values) const;
  std::size_t bytes() const { return springs_.size() * sizeof(Spring); }

 private:
  struct Spring {
    Facet nodes;
    double area;               ///< m^2
    Eigen::Matrix3d per_area;  ///< k_n N x N + k_t (1 - N x N), N/m^3
  };
  std::vector<Spring> springs_;
  Eigen::Matrix<double, 6, 6> mass_;  ///< integrals of N_a N_b over a facet of area 1
};

}  // namespace palpate::fem
