// SPDX-License-Identifier: AGPL-3.0-or-later
// Reduces the stiffness of a library until it can be certified for a given bound.
#pragma once

#include <cstddef>
#include <limits>

#include "fitting/certificate/certify.hpp"
#include "format/library.hpp"

namespace palpate::fitting {

/// Changes made by soften().
struct Softening {
  double max_slope = std::numeric_limits<double>::infinity();  ///< N/m; infinite: nothing changed
  std::size_t curves = 0;                                      ///< number of changed curves
  /// Fraction of the force at the last knot that is lost, over both curves of all nodes.
  double median = 0, p95 = 0, worst = 0;
};

/// Certifies the library for `bound`, N/m.
/// Where max(L_stick, L_slip) exceeds it, `bound` becomes the enforced bound, to which the runtime
/// rate-limits slides. Where L_min exceeds it too, the slopes of all curves are limited to the
/// largest value (found by bisection) that reduces L_min to `bound`. Smaller slopes are unchanged.
/// @throws Error(Configuration) when even one hundredth of the largest slope is not certifiable.
/// The responses are then unchanged.
Softening soften(Library& library, const CertifySettings& settings, double bound);

}  // namespace palpate::fitting
