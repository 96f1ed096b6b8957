// SPDX-License-Identifier: AGPL-3.0-or-later
// Starts of a fit of a Prony series.
#pragma once

#include <cstddef>
#include <vector>

#include "fitting/measurement/relaxation/history_model.hpp"

namespace palpate::calibrate {

struct SeriesStart {
  double force = 0, exponent = 0;  ///< N, p
  std::vector<double> fraction, time;
  double misfit = 0;  ///< sum of the squares of the residuals in force
};

/// At given times and exponent the force of a record is linear in g_inf F and g_i F. All sets of
/// `terms` of these times are solved for each exponent; the best few that have no negative part are
/// the starts [Golub & Pereyra 1973, the separation].
/// @param times  s, ascending. @param few  starts at most, the best first; none where every set has
///   a negative part.
std::vector<SeriesStart> series_starts(const HistoryModel& model,
                                       const std::vector<double>& exponents,
                                       const std::vector<double>& times, std::size_t terms,
                                       std::size_t few);

}  // namespace palpate::calibrate
