// SPDX-License-Identifier: AGPL-3.0-or-later
// Baseline and contact point of one press of a record.
#pragma once

#include "fitting/measurement/records/cycles.hpp"
#include "fitting/measurement/records/press.hpp"

namespace palpate::measured {

struct BaselineAndContact {
  Baseline baseline;
  ContactPoint contact;
  CommonErrors common;
};

/// Estimate both together, by fit_onset up to three fractions of the largest force. A drift is
/// among the unknowns where the samples out of contact determine it: where they alone give the
/// baseline at the end of loading to the noise of one sample, or to 1 % of the largest force.
/// Elsewhere no drift is removed; one that those samples show (one time in a hundred by chance) is
/// Suspected.
/// @throws Error(Configuration) as analyse_press.
BaselineAndContact baseline_and_contact(const PressRecord& record, const Cycle& cycle,
                                        const PressSettings& settings);

}  // namespace palpate::measured
