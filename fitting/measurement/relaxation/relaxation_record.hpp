// SPDX-License-Identifier: AGPL-3.0-or-later
// The part of a recorded history that a series is fitted to.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fitting/measurement/records/history.hpp"

namespace palpate::calibrate {

struct RelaxationRecord {
  std::string name;
  bool force_is_held = false;  ///< creep: the travel follows the force
  std::vector<double> time;    ///< s, strictly increasing, from the contact on
  std::vector<double> travel;  ///< m, from the contact point, not negative
  std::vector<double> force;   ///< N
  double ramp = 0;             ///< s, from the contact to the first hold or turn
  std::size_t stride = 1;      ///< every stride-th sample of the history

  double span() const { return time.back() - time.front(); }
  /// Median time between samples, s.
  double interval() const;
};

/// The samples from the contact to the end of the last hold; of a history of cycles without a hold,
/// to its end. Where they are more than `most`, every second, third, ... of them.
/// @throws Error(Configuration) as require_time_dependence, and for a record whose first sample in
///   contact is deeper than a fifth of the largest travel: its ramp is not recorded.
RelaxationRecord relaxation_record(const measured::History& history, std::size_t most = 10000);

}  // namespace palpate::calibrate
