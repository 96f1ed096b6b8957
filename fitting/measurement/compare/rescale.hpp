// SPDX-License-Identifier: AGPL-3.0-or-later
// Curves with the shape of a simulation and the scale of a measurement.
#pragma once

#include <string>
#include <vector>

#include "fitting/measurement/compare/compare.hpp"
#include "fitting/measurement/records/history.hpp"
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

/// The same with whole records instead of loading curves: measured = s * the force that the
/// simulated curve of the site shows along the recorded travel when it relaxes, which is
///   integral of g(t - s) de(x(s)),
/// with e its instantaneous force and g by the relaxation fractions of the site; an elastic
/// campaign does not relax. So the time in which a press was made does not bias the scale. Samples
/// beyond the deepest simulated one are left out.
/// @throws Error(Configuration) when a record is at no site with a simulated press, or all of it is
///   deeper than that, or a factor is not positive.
Rescaling rescale_over_time(const Curves& simulated,
                            const std::vector<measured::SiteHistory>& records);

}  // namespace palpate::compare
