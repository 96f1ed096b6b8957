// SPDX-License-Identifier: AGPL-3.0-or-later
// How closely the responses of a library follow the curves that they were fitted to.
#pragma once

#include <cstdint>
#include <vector>

#include "format/curves.hpp"
#include "format/library.hpp"

namespace palpate::fitting {

/// Relative error above which a fit visibly misses its samples.
inline constexpr double kVisibleFitError = 0.05;

/// Largest errors of the responses of a site, each relative to the largest force of its samples.
struct SiteFitError {
  std::int32_t vertex = -1;
  double normal = 0;       ///< of the normal response
  double lateral = 0;      ///< of the lateral response, to the mean of the paths that it stands for
  double spread = 0;       ///< of the lateral response, to any single path
  double mesh = kUnknown;  ///< of the mesh in the normal curves; NaN when unknown
  double lateral_mesh = kUnknown;  ///< of the mesh in the lateral curves; NaN when unknown
};

/// The errors of every fitted site, in the order of the curves. A decoupled lateral response stands
/// for the paths of all azimuths and depths, a coupled one at each depth for those of all azimuths.
/// A lateral force below a hundredth of the largest normal force counts as that hundredth: beside
/// the normal force its error is not felt.
/// @pre the library was fitted to the curves.
std::vector<SiteFitError> fit_errors(const Library& library, const Curves& curves);

/// Median and largest of those relative errors that are known, and the site of the largest.
struct FitErrorSummary {
  double median = 0, worst = 0;
  std::int32_t vertex = -1;  ///< -1: no site was fitted
};
FitErrorSummary summary_of(const std::vector<SiteFitError>& errors, double SiteFitError::*which);

}  // namespace palpate::fitting
