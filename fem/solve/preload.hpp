// SPDX-License-Identifier: AGPL-3.0-or-later
// The body under its weight, before the tool touches it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "fem/factor/memory.hpp"
#include "fem/solid/solid_model.hpp"
#include "fem/solve/preload_progress.hpp"

namespace palpate::fem {

/// How an equilibrium under the weight is computed. The bits do not depend on it.
struct PreloadOptions {
  FactorResources resources;
  PreloadCounter::Tell progress;  ///< called in every step; may be null
};

/// The displacement in equilibrium with the weight; 0 without gravity. The weight is applied at
/// once (PartialWeight), and in parts, from one equilibrium to the next, where that does not
/// converge or where the displacement is many times that of the linear body. Then the smallest
/// eigenvalue of the stiffness is followed: an equilibrium beyond the weight at which it vanishes
/// is one of several, chosen by the rounding of the mesh, and is refused. `permutation`:
/// elimination order of the model.
/// @throws Error(Configuration) when a factorization needs more memory than it may use.
/// @throws Error(Geometry) when the body buckles or collapses, with the fraction of the weight and
/// the place, when an element is crushed or when Newton's method does not converge; `owner` names
/// the body.
Displacement equilibrium_under_weight(const SolidModel& model, const std::vector<int>& permutation,
                                      const std::string& owner, const PreloadOptions& options = {});

/// A point of a facet, with the shape functions of its nodes there.
struct BoundaryPoint {
  Facet facet;
  std::array<double, 6> N;
  /// A field of the nodes, (3, nodes), at the point.
  Eigen::Vector3d value(const Eigen::Matrix3Xd& field) const;
};
/// The point of the boundary nearest to x where its nodes are at `positions`, (3, nodes), m; facets
/// are taken as flat.
BoundaryPoint nearest_boundary_point(const QuadraticMesh& mesh, const Eigen::Matrix3Xd& positions,
                                     const Eigen::Vector3d& x);

/// Displacement of the point of the boundary nearest to X.
Eigen::Vector3d displacement_at(const QuadraticMesh& mesh, const Displacement& u,
                                const Eigen::Vector3d& X);

}  // namespace palpate::fem
