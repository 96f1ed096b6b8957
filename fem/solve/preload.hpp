// SPDX-License-Identifier: AGPL-3.0-or-later
// The body under its weight, before the tool touches it.
#pragma once

#include <string>
#include <vector>

#include "fem/solid/solid_model.hpp"

namespace palpate::fem {

/// The displacement in equilibrium with the weight; 0 without gravity. Newton's method with a
/// factorization in each step; the weight is applied in parts where the whole does not converge.
/// The residual is at most 1e-9 of the weight. `permutation`: elimination order of the model.
/// @throws Error(Geometry) when no equilibrium is found, with the fraction of the weight that was
/// reached; `owner` names the body.
Displacement equilibrium_under_weight(const SolidModel& model, const std::vector<int>& permutation,
                                      const std::string& owner);

/// Displacement of the point of the boundary nearest to X.
Eigen::Vector3d displacement_at(const QuadraticMesh& mesh, const Displacement& u,
                                const Eigen::Vector3d& X);

}  // namespace palpate::fem
