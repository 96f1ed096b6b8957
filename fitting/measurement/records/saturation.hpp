// SPDX-License-Identifier: AGPL-3.0-or-later
// Presses beyond the range of the load cell: readings that stay at exactly their extreme while the
// tool goes on.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "fitting/measurement/records/cycles.hpp"

namespace palpate::measured {

/// Samples first .. last of the record have the extreme reading.
struct Saturation {
  double reading = 0;  ///< N, as recorded; of the channel of the load cell that is at its limit
  double travel = 0;   ///< m, by which the tool goes on meanwhile
  double from = 0, to = 0;  ///< s, as recorded; kUnknown without a time
  std::size_t first = 0, last = 0;
};

/// The saturation of one channel while a press goes in: a limit that no reading of the record
/// passes. Its longest run of three or more equal extreme readings is compared with the runs before
/// it, in the upper half of its rise: it is no plateau of the resolution, or of a tool that is
/// slow, unless it covers more than 3 times the travel of the longest run of equal readings,
/// and 1.5 times that of the longest step between two readings. Single extreme readings shortly
/// before it are those of noise at the limit: they begin it.
/// @param readings, displacement  of the whole record; displacement grows into the body
std::optional<Saturation> saturation_of(const std::vector<double>& readings,
                                        const std::vector<double>& displacement,
                                        const Cycle& cycle);

}  // namespace palpate::measured
