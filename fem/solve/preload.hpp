// SPDX-License-Identifier: AGPL-3.0-or-later
// The body before it is touched: sagged under its weight, or at rest.
#pragma once

#include <string>
#include <vector>

#include "fem/solid/solid_model.hpp"

namespace palpate::fem {

/// The displacement at which the body carries its weight; 0 without gravity. Newton's method with a
/// factorization a step; the weight is put on in parts where all at once does not converge. The
/// forces left are 1e-9 of the weight. `permutation`: elimination order of the model.
/// @throws Error(Geometry) when no equilibrium is found, with the part of the weight that was
/// carried; `owner` names the body.
Displacement equilibrium_under_weight(const SolidModel& model, const std::vector<int>& permutation,
                                      const std::string& owner);

/// Of a point on the boundary, or of the point of the boundary nearest to it.
Eigen::Vector3d displacement_at(const QuadraticMesh& mesh, const Displacement& u,
                                const Eigen::Vector3d& X);

}  // namespace palpate::fem
