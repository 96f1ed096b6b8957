// SPDX-License-Identifier: AGPL-3.0-or-later
// Curves with the shape of a simulation and the scale of a measurement.
#pragma once

#include <string>
#include <vector>

#include "fitting/measurement/compare/compare.hpp"
#include "format/curves.hpp"

namespace palpate::compare {

/// The factor between the curves of one site, and what it leaves over.
struct SiteScale {
  std::int32_t vertex = -1;
  double factor = 0;
  double uncertainty = 0;  ///< standard, of the misfit
  double misfit = 0;  ///< root mean square of measured less scaled force over the largest force
};

struct Rescaling {
  double factor = 1;       ///< for all sites
  double uncertainty = 0;  ///< standard: the larger of what the sites state and their disagreement
  std::vector<SiteScale> sites;
  Curves curves;  ///< the simulated ones, forces and energies times the factor
};

/// Least squares factor s of measured = s * simulated over the normal paths of the common sites,
/// each site with the same weight. Exact for a body of one law whose stress scale alone is unknown:
/// the force of an indentation is proportional to it. The misfits measure a difference in shape.
/// @throws Error(Configuration) when no site is common, or a factor is not positive.
Rescaling rescale(const Curves& simulated, const Curves& measured, const CompareSettings& settings);

}  // namespace palpate::compare
