// SPDX-License-Identifier: AGPL-3.0-or-later
// Fits of tests whose specimens are held by glued clamps, where the homogeneous formulas are off.
#pragma once

#include <optional>
#include <vector>

#include "fem/specimen/clamped.hpp"
#include "fitting/measurement/calibrate/homogeneous_fit.hpp"

namespace palpate::app {

/// Finite elements over formula: the nominal stress of a clamped specimen over that of its mode.
class ClampEffect {
 public:
  /// Around a state of rest the ratio is that of the smallest stretch that is computed.
  /// @param stretches  those of the test.
  /// @throws Error(Configuration) as fem::clamped_stress.
  ClampEffect(const fem::ClampedSpecimen& specimen, calibrate::Mode mode,
              const std::vector<double>& stretches);
  double at(double stretch) const;

 private:
  std::vector<double> stretch_, ratio_;  ///< ascending
};

struct ClampedFit {
  calibrate::HomogeneousFit fit;       ///< its predictions are those of the clamped specimens
  int rounds = 0;                      ///< of fits
  std::vector<double> largest_effect;  ///< of each test, |ratio - 1|; 0 where it is not clamped
};

/// fit_homogeneous() where the stress of each clamped test is that of the law times the effect of
/// its clamps, which is computed anew at the constants that were found until it no longer changes.
/// The change of the effect with the constants is in no interval.
/// @param specimens  of each test; nothing where it is homogeneous.
/// @throws Error(Configuration) as both; where the constants do not settle.
ClampedFit fit_clamped(const std::vector<calibrate::HomogeneousTest>& tests,
                       const std::vector<std::optional<fem::ClampedSpecimen>>& specimens,
                       const calibrate::HomogeneousSettings& settings);

}  // namespace palpate::app
