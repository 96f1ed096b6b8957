// SPDX-License-Identifier: AGPL-3.0-or-later
// Intervals of the linearised model at a best fit.
#pragma once

#include <vector>

#include "fitting/measurement/calibrate/least_squares.hpp"

namespace palpate::calibrate {

/// Fill what `result` says of the scatter, the correlations and the intervals of its estimates.
/// @param J, r  Jacobian (row by row) and residuals at the best fit.
void add_intervals(const LeastSquares& problem, const std::vector<double>& J,
                   const std::vector<double>& r, Calibration& result);

}  // namespace palpate::calibrate
