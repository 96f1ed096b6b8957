// SPDX-License-Identifier: AGPL-3.0-or-later
// Where a calibrated law stops resisting deformation.
#pragma once

#include <array>
#include <vector>

#include "fitting/measurement/calibrate/incompressible_law.hpp"

namespace palpate::calibrate {

/// The first deformation of a mode, going away from rest within a range, at which the tangent is
/// not positive.
struct StabilityLimit {
  Mode mode = Mode::Uniaxial;
  double low = 0, high = 0;  ///< range that was searched
  double unstable_at = 0;    ///< NaN when there is none
};
StabilityLimit stability_in(const IncompressibleLaw& law, const std::vector<double>& constants,
                            StabilityLimit range);

/// The same over all states whose principal logarithmic strains do not exceed a largest one. A body
/// in contact meets states that no test mode reaches.
struct StabilityOfStates {
  double largest_strain = 0;  ///< logarithmic
  /// Principal stretches of the unstable state of least strain; NaN when there is none.
  std::array<double, 3> unstable_at{};
};
StabilityOfStates stability_of_states(const IncompressibleLaw& law,
                                      const std::vector<double>& constants, double largest_strain);

}  // namespace palpate::calibrate
