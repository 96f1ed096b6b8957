// SPDX-License-Identifier: AGPL-3.0-or-later
// The presses of a record, by the turning points of the displacement.
#pragma once

#include <cstddef>
#include <vector>

namespace palpate::measured {

/// One press: samples begin .. peak go in, peak .. end come back. Those from `before` to begin
/// belong to the press before it, on its way back, or are a wait before the first press.
struct Cycle {
  std::size_t before = 0, begin = 0, peak = 0, end = 0;
  /// Without the samples of a hold at the deepest point: one past the last of loading, the first of
  /// unloading.
  std::size_t loading_end = 0, unloading_begin = 0;
};

/// Deep points and, between them, shallow ones, by a zigzag that ignores turns below 30 % of the
/// range.
std::vector<Cycle> cycles_of(const std::vector<double>& displacement);

/// Standard deviation of the noise of a signal that is smooth otherwise, by second differences.
double noise_of(const std::vector<double>& signal);

}  // namespace palpate::measured
