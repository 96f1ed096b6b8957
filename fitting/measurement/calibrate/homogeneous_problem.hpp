// SPDX-License-Identifier: AGPL-3.0-or-later
// Tests in homogeneous deformations as a least squares problem.
#pragma once

#include <vector>

#include "fitting/measurement/calibrate/homogeneous_fit.hpp"
#include "fitting/measurement/calibrate/scan.hpp"

namespace palpate::calibrate {

struct HomogeneousProblem {
  LeastSquares squares;  ///< the constants of the law, then the offsets of the tests that have one
  std::vector<WeightedSample> samples;
  std::vector<bool> offset;  ///< of each test, whether one is fitted

  /// Full sets of starts, offsets included: of the data, and with given starts in their places.
  std::vector<std::vector<double>> starts(const IncompressibleLaw& law,
                                          const HomogeneousSettings& settings, bool any_sign) const;
};

/// Root of the mean square.
double rms(const std::vector<double>& values);

/// @param wide  bounds are those of wide_constants() instead of default_constants(). Constants in
///   the settings keep theirs.
/// The problem refers to the tests. @throws Error(Configuration) as fit_homogeneous().
HomogeneousProblem problem_of(const std::vector<HomogeneousTest>& tests,
                              const HomogeneousSettings& settings, const IncompressibleLaw& law,
                              bool wide);

}  // namespace palpate::calibrate
