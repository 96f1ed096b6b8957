// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/cycles.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/measurement/records/statistics.hpp"

namespace palpate::measured {
namespace {

/// A turn of the displacement counts when it comes back by this fraction of the whole range.
constexpr double kTurnOfCycle = 0.3;

/// Deep points and, between them, shallow ones, by a zigzag that ignores turns below a fraction of
/// the range.
std::vector<Cycle> zigzag(const std::vector<double>& x) {
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  const double turn = kTurnOfCycle * (*high - *low);
  std::vector<Cycle> cycles;
  std::size_t lowest = 0, highest = 0;
  bool rising = false;
  Cycle cycle;
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (!rising) {
      if (x[i] <= x[lowest]) lowest = i;
      if (x[i] - x[lowest] <= turn) continue;
      if (!cycles.empty()) cycles.back().end = lowest + 1;
      cycle = Cycle{};
      cycle.begin = lowest;
      cycle.peak = i;
      cycle.end = x.size();
      highest = i;
      rising = true;
      continue;
    }
    if (x[i] > x[highest]) highest = i;
    if (x[highest] - x[i] <= turn) continue;
    cycle.peak = highest;
    cycles.push_back(cycle);
    rising = false;
    lowest = i;
  }
  if (rising) {
    cycle.peak = highest;
    cycles.push_back(cycle);
  }
  return cycles;
}

/// The samples of a hold at the deepest point belong to neither branch.
void leave_out_hold(const std::vector<double>& x, Cycle& cycle) {
  const double still = x[cycle.peak] - 4 * noise_of(x) - 1e-12;
  cycle.loading_end = cycle.peak + 1;
  while (cycle.loading_end > cycle.begin + 1 && x[cycle.loading_end - 2] >= still) {
    --cycle.loading_end;
  }
  cycle.unloading_begin = cycle.peak;
  while (cycle.unloading_begin + 1 < cycle.end && x[cycle.unloading_begin + 1] >= still) {
    ++cycle.unloading_begin;
  }
}

}  // namespace

double noise_of(const std::vector<double>& x) {
  std::vector<double> second;
  for (std::size_t i = 2; i < x.size(); ++i) {
    second.push_back(std::abs(x[i] - 2 * x[i - 1] + x[i - 2]));
  }
  if (second.empty()) return 0;
  constexpr double median_to_deviation = 1.4826;  // of a normal distribution
  return median_to_deviation * median(second) / std::sqrt(6.0);
}

std::vector<Cycle> cycles_of(const std::vector<double>& displacement) {
  std::vector<Cycle> cycles = zigzag(displacement);
  std::size_t before = 0;
  for (Cycle& cycle : cycles) {
    cycle.before = before;
    before = cycle.peak;
    leave_out_hold(displacement, cycle);
  }
  return cycles;
}

}  // namespace palpate::measured
