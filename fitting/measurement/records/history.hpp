// SPDX-License-Identifier: AGPL-3.0-or-later
// A record kept whole: travel and force over time, with the phases of the test. Presses that become
// curves keep their loading branch alone, see press.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fitting/measurement/records/phases.hpp"
#include "fitting/measurement/records/press.hpp"

namespace palpate::measured {

/// A phase that is declared, by the time of the record, s.
struct DeclaredPhase {
  PhaseKind kind = PhaseKind::Hold;
  double from = 0, to = 0;
};

struct HistorySettings {
  PressSettings press;
  std::optional<Control> control;       ///< none: recognised
  std::vector<DeclaredPhase> declared;  ///< in order of time; empty: recognised
};

struct History {
  std::string name;  ///< for messages
  Control control = Control::Travel;
  std::vector<double> time;    ///< s, as recorded, strictly increasing
  std::vector<double> travel;  ///< m, from the contact point, less what the machine yields
  std::vector<double> force;   ///< N, less the baseline
  std::vector<Phase> phases;   ///< in order of time, without overlap
  Baseline baseline;
  ContactPoint contact;
  std::optional<Saturation> saturation;  ///< of the first press; its samples are kept, too
};

/// A record and the site at which it was made.
struct SiteHistory {
  std::int32_t vertex = -1;  ///< -1: not on a body
  History history;
};

/// Baseline and contact point are those of analyse_press for the first press of the record; all
/// samples are kept. A drift of the baseline is removed where it is known, by the end of the
/// record, to the noise of one sample or to 1 % of the largest force; elsewhere none is.
/// @throws Error(Configuration) naming the record: no time, times that do not increase, values that
///   are not finite, declared phases that overlap, go back or hold no sample; as analyse_press.
History analyse_history(const PressRecord& record, const HistorySettings& settings);

/// Throws Error(Configuration) unless the record shows how the force depends on time: a hold in
/// contact of at least 20 samples and as long as the ramp before it, or two cycles.
void require_time_dependence(const History& history);

}  // namespace palpate::measured
