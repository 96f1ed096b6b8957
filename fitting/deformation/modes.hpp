// SPDX-License-Identifier: AGPL-3.0-or-later
// The best few shapes for many fields.
#pragma once

#include <Eigen/Core>

namespace palpate::fitting {

/// fields ~ shapes coefficients, with orthonormal shapes.
struct Modes {
  Eigen::MatrixXf shapes;        ///< (rows, M)
  Eigen::MatrixXf coefficients;  ///< (M, columns)
};

/// The leading left singular vectors of the fields by a randomized range finder with power
/// iterations [Halko, Martinsson & Tropp 2011, algorithm 4.4 and 5.1]; deterministic. At most
/// `most` of them, and none whose singular value is below `least` of the largest.
Modes leading_modes(const Eigen::MatrixXf& fields, Eigen::Index most, double least);

}  // namespace palpate::fitting
