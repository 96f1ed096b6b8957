// SPDX-License-Identifier: AGPL-3.0-or-later
// Least squares within bounds from one start.
#pragma once

#include <optional>

#include "fitting/measurement/calibrate/descent.hpp"

namespace palpate::calibrate {

/// From the starts of the constants downhill, by steps of the linearised problem within the bounds
/// [Levenberg 1944; Marquardt 1963]. The damping follows the gain, the decrease of the cost over
/// the one that the linear problem promised. Has converged where the cost or the step no longer
/// changes, or where the linear problem promises no more than problem.offset_tolerance allows.
/// None where the model has no value at the start.
std::optional<Minimum> levenberg_marquardt(const LeastSquares& problem);

}  // namespace palpate::calibrate
