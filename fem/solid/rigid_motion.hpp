// SPDX-License-Identifier: AGPL-3.0-or-later
// The rigid part of a motion of the body: a body on soft springs, or on a small support, turns as a
// whole, and a linear step along such a turn would stretch it.
#pragma once

#include <Eigen/Core>

#include "fem/solid/solid_model.hpp"

namespace palpate::fem {

/// The rotation of all nodes that is nearest to a displacement, in the sense of least squares
/// [Kabsch 1976].
Eigen::Matrix3d mean_rotation(const QuadraticMesh& mesh, const Displacement& u);

/// u += s d on the unknowns of the model, with the rigid turn in it, the least-squares fit of
/// v + w x (x - c) to d, made as the rotation exp(s w) around c instead of along its tangent. The
/// two differ by second order in s w, and by nothing at c, the middle of what is held or on
/// springs; turns of less than 2 mrad are left as they are.
void move_turning(const SolidModel& model, double s, const Eigen::VectorXd& d, Displacement& u);

}  // namespace palpate::fem
