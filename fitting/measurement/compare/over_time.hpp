// SPDX-License-Identifier: AGPL-3.0-or-later
// A model against a record over time: what it renders of the same motion.
#pragma once

#include <vector>

#include "fitting/measurement/records/history.hpp"
#include "format/numbers.hpp"

namespace palpate::compare {

/// What is left of the force at the end of a hold, of that at its begin. The forces are means over
/// a hundredth of the hold at either end, at least one sample.
struct HeldForce {
  double from = 0, to = 0;  ///< s
  double measured = 0, model = 0;
};

/// The motion from the first contact on; outside of it nothing is compared.
struct TimeComparison {
  std::vector<double> time, travel, measured, model;  ///< s, m, N, N
  double rmse = 0;                                    ///< N
  double normalised_rmse = 0;                         ///< over the largest measured force
  double bias = 0;                                    ///< N, mean of model less measured
  double worst = 0, worst_time = 0;                   ///< N, model less measured; s
  double peak_error = 0;  ///< N, largest model force less largest measured force
  /// J, integral of f dx over the record, which is what is lost in its cycles; NaN without a
  /// release.
  double measured_loss = kUnknown, model_loss = kUnknown;
  std::vector<HeldForce> holds;  ///< of a travel that is held
};

/// @param model  force at each sample of the history, N.
/// @throws Error(Configuration) for a history without a ramp, and Error(Internal) for another
///   number of forces.
TimeComparison over_time(const measured::History& history, const std::vector<double>& model);

/// The samples that a motion of straight lines needs to stay within `tolerance` (m) of the travel
/// [Douglas & Peucker 1973], the first and the last among them.
std::vector<std::size_t> corners_of(const std::vector<double>& time,
                                    const std::vector<double>& travel, double tolerance);

}  // namespace palpate::compare
