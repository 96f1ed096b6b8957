// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace palpate::fitting {

/// Minimises |A x - b| over x >= 0 by the active-set method [Lawson & Hanson 1974, ch. 23].
/// The result satisfies the Karush-Kuhn-Tucker conditions: with w = A^T (b - A x),
/// w_j = 0 where x_j > 0 and w_j <= 0 where x_j = 0, up to rounding. Dense, for tens of unknowns.
/// @throws Error(Internal) when the active set does not converge.
Eigen::VectorXd nonnegative_least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

}  // namespace palpate::fitting
