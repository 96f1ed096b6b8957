// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/records/saturation.hpp"

#include <algorithm>
#include <cmath>

#include "format/numbers.hpp"

namespace palpate::measured {
namespace {

constexpr std::size_t kFewestEqual = 3;
constexpr double kLongerThanRuns = 3, kLongerThanSteps = 1.5;
constexpr std::size_t kNearby = 3;  ///< samples without the extreme between two with it

/// Consecutive samples begin .. end - 1 with one reading.
struct Run {
  std::size_t begin = 0, end = 0;
  std::size_t size() const { return end - begin; }
};

std::vector<Run> runs_of(const std::vector<double>& readings, std::size_t begin, std::size_t end) {
  std::vector<Run> runs;
  for (std::size_t i = begin; i < end; ++i) {
    if (runs.empty() || readings[i] != readings[runs.back().begin])
      runs.push_back({i, i + 1});
    else
      runs.back().end = i + 1;
  }
  return runs;
}

/// Without the single extreme readings before a run, which noise makes near the limit.
std::size_t onset_of(const std::vector<double>& readings, std::size_t begin, std::size_t run) {
  const double extreme = readings[run];
  std::size_t first = run;
  for (std::size_t i = run; i-- > begin && first - i <= kNearby + 1;)
    if (readings[i] == extreme) first = i;
  return first;
}

}  // namespace

std::optional<Saturation> saturation_of(const std::vector<double>& readings,
                                        const std::vector<double>& displacement,
                                        const Cycle& cycle) {
  if (cycle.loading_end <= cycle.begin) return {};
  const double start = readings[cycle.begin];
  double extreme = start;
  for (std::size_t i = cycle.begin; i < cycle.loading_end; ++i)
    if (std::abs(readings[i] - start) > std::abs(extreme - start)) extreme = readings[i];
  const auto is_beyond = [&](double reading) {
    return extreme > start ? reading > extreme : reading < extreme;
  };
  if (std::ranges::any_of(readings, is_beyond)) return {};
  const std::vector<Run> runs = runs_of(readings, cycle.begin, cycle.loading_end);
  const auto longest = std::ranges::max_element(runs, {}, [&](const Run& run) {
    return readings[run.begin] == extreme ? run.size() : std::size_t{0};
  });
  if (readings[longest->begin] != extreme || longest->size() < kFewestEqual) return {};
  const auto travel = [&](std::size_t a, std::size_t b) {
    return displacement[b] - displacement[a];
  };
  const double covered = travel(longest->begin, longest->end - 1);
  bool compared = false;
  for (auto run = runs.begin(); run != longest; ++run) {
    const bool upper = std::abs(readings[run->begin] - extreme) < 0.5 * std::abs(extreme - start);
    if (readings[run->begin] == extreme || (!upper && run + 1 != longest)) continue;
    const double factor = run->size() > 1 ? kLongerThanRuns : kLongerThanSteps;
    if (covered <= factor * travel(run->begin, run->end)) return {};
    compared = true;
  }
  if (!compared) return {};
  Saturation found;
  found.reading = extreme;
  found.travel = covered;
  found.from = found.to = kUnknown;
  found.first = onset_of(readings, cycle.begin, longest->begin);
  found.last = longest->end - 1;
  return found;
}

}  // namespace palpate::measured
