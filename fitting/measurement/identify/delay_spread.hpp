// SPDX-License-Identifier: AGPL-3.0-or-later
// How a delay varies from sample to sample.
#pragma once

#include <cstddef>

#include "fitting/measurement/identify/measured.hpp"
#include "fitting/measurement/identify/motion_record.hpp"

namespace palpate::identify {

class AxisEquations;
struct EquationFit;

struct DelaySpread {
  /// s, from a sample to its force: the largest of the dated jumps; deviation: of one date.
  Measured latest;
  std::size_t dated = 0;       ///< jumps
  double lateness = kUnknown;  ///< s, by how much a position is older than the mean: the largest
  double lateness_range = kUnknown;  ///< s, between the latest and the earliest position
};

/// A jump df of the command at t, in a window of one-way motion around t + D, leaves the impulse
/// df times the antiderivative of the test function from D to its own delay: so each jump is dated.
/// A position that is late by s differs from a smooth motion by -v s: from the parabola through ten
/// neighbours, where the speed is above half of the largest.
/// @param delay  D, s, the mean, of which `fit` is the solution
DelaySpread delay_spread(const MotionRecord& record, const AxisEquations& equations,
                         const EquationFit& fit, double delay);

/// Delay for (C7) of [theory-certificate], s: the largest delay of a sample and three quarters of
/// what lengthens the period, (C11). NaN where the spread is not known.
/// @param longer  s, by how much a period is longer than the nominal one: the largest
double delay_bound(const Measured& mean, const DelaySpread& spread, double longer);

}  // namespace palpate::identify
