// SPDX-License-Identifier: AGPL-3.0-or-later
// A recorded press as tissue would show it that has no time to relax.
#pragma once

#include <string>

#include "fitting/measurement/records/press.hpp"
#include "format/curves.hpp"
#include "format/relaxation.hpp"

namespace palpate::measured {

/// The press with the forces of its loading branch replaced by the instantaneous ones e of
///   f(t) = integral of g(t - s) de(s),
/// g the series [Fung 1981, sec. 7.6], solved step by step with e linear between the samples.
/// Where the branch lacks the samples of a pause, e is constant until the last usual interval. What
/// is known of noise and contact point stays that of the recorded force; the uncertainty of the
/// series is not counted.
/// @throws Error(Configuration) naming `where` for a press without a time.
PressCurve before_relaxing(PressCurve press, const RelaxationSeries& series,
                           const std::string& where);

/// Declares that what the press of a site stores relaxes by the series: all of it, as the series of
/// a measurement is that of the force. The energy stored at once is the work of the instantaneous
/// force.
void let_relax(SiteCurves& site);

}  // namespace palpate::measured
