// SPDX-License-Identifier: AGPL-3.0-or-later
// The phases of a test that is recorded over time.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace palpate::measured {

/// What the machine holds in a hold: the travel, while the force relaxes, or the force, while the
/// body creeps.
enum class Control { Travel, Force };

enum class PhaseKind {
  Approach,  ///< towards the body, out of contact
  Rest,      ///< no motion, out of contact
  Ramp,      ///< in contact, deeper or with more force
  Hold,      ///< in contact, travel or force constant
  Release    ///< back
};

std::string_view phase_name(PhaseKind kind);  ///< "hold", ...
std::optional<PhaseKind> phase_of_name(std::string_view name);

/// Samples begin .. end - 1.
struct Phase {
  PhaseKind kind = PhaseKind::Hold;
  std::size_t begin = 0, end = 0;

  bool operator==(const Phase&) const = default;
};

struct PhaseSignals {
  const std::vector<double>& time;          ///< s, strictly increasing
  const std::vector<double>& displacement;  ///< m, of the machine: what it holds
  const std::vector<double>& travel;        ///< m, from the contact point
  const std::vector<double>& force;         ///< N, less the baseline
};

/// What is held: the signal with the longest hold in contact; the travel where they are alike to a
/// tenth.
Control control_of(const PhaseSignals& signals);

/// A hold is a run of ten samples or more within a band of the signal that is held, 1 % of the
/// range of a travel, 2 % of that of a force, or four times their noise, thirty times as long as
/// the mean speed of the moving parts takes through the band. Motion between holds is divided where
/// it turns by a twentieth of the range.
std::vector<Phase> phases_of(const PhaseSignals& signals, Control control);

}  // namespace palpate::measured
