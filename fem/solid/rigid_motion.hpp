// SPDX-License-Identifier: AGPL-3.0-or-later
// The rigid part of a motion of the body: a body on soft springs, or on a small support, rotates as
// a whole, and a linear step along a rotation would stretch it.
#pragma once

#include <Eigen/Core>

#include "fem/solid/solid_model.hpp"

namespace palpate::fem {

/// The rotation that is nearest to a matrix, in the sense of least squares [Kabsch 1976]: the polar
/// factor where its determinant is positive.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix);

/// The rotation of all nodes that is nearest to a displacement.
Eigen::Matrix3d mean_rotation(const QuadraticMesh& mesh, const Displacement& u);

/// u += s d on the unknowns of the model. The rigid rotation w in d, by the least-squares fit of
/// v + w x (x - c), is applied as exp(s w) around c instead of along its tangent; c is the mean
/// position of the nodes that are fixed or on springs. The two differ by second order in s w;
/// rotations of less than 2 mrad are applied linearly.
void add_rotating_step(const SolidModel& model, double s, const Eigen::VectorXd& d,
                       Displacement& u);

}  // namespace palpate::fem
