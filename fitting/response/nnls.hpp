// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace palpate::fitting {

/// The x >= 0 that minimises |A x - b|, by the active-set method [Lawson & Hanson 1974, ch. 23].
/// The result meets the conditions of optimality (Karush-Kuhn-Tucker): with w = A^T (b - A x),
/// w_j = 0 where x_j > 0 and w_j <= 0 where x_j = 0, up to rounding. Dense, for tens of unknowns.
/// @throws Error(Internal) when the active set does not settle (not seen; guards the loop).
Eigen::VectorXd nonnegative_least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

}  // namespace palpate::fitting
