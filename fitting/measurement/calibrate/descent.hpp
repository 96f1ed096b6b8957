// SPDX-License-Identifier: AGPL-3.0-or-later
// One descent of a least squares problem, without anything said about the result.
#pragma once

#include <optional>
#include <vector>

#include "fitting/measurement/calibrate/least_squares.hpp"

namespace palpate::calibrate {

/// Where a descent ended.
struct Minimum {
  std::vector<double> at, residuals;
  std::vector<double> J;  ///< J[row * constants + column], there
  double cost = 0;
  bool converged = false;  ///< the cost, the step or the slope says that it does not get better
  int iterations = 0;
};

/// From the starts of the constants; none where the model has no value there.
std::optional<Minimum> descend(const LeastSquares& problem);

}  // namespace palpate::calibrate
