// SPDX-License-Identifier: AGPL-3.0-or-later
// Force steps of a tool that slides over a sphere, each timed by itself. Several passes along one
// trajectory, each with a fresh state and swept caches, do the same work at the same step (their
// forces are checked to be equal), and hardly ever does an interrupt meet the same step in all of
// them. The least time of each step over the passes is what it takes where nothing interferes: a
// lower bound, as it is also the luckiest of them.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "format/vec3.hpp"

namespace palpate::bench {

using Clock = std::chrono::steady_clock;

inline constexpr double kRate = 1000;  // Hz
inline constexpr int kSteps = 200000;
inline constexpr int kPasses = 5;

/// What the tip does on the sphere of octasphere.hpp: it presses along a line, 1.5 to 4.5 mm deep;
/// or slides along a curve that winds over the sphere at 0.1 m/s, 3 mm deep; or both at once.
enum class Motion : std::uint8_t { Press, Slide, Both };
std::vector<Vec3> trajectory(Motion motion = Motion::Both);

/// Where the tool is before it: outside, above its second point, as the first is below a vertex.
Vec3 outside();

/// Steps from the surface to the begin of a press. A tool that begins inside has a depth offset,
/// which no friction pays for where it only presses.
std::vector<Vec3> approach();

/// Median time of an empty measurement, ns, which is part of each time.
double clock_cost();

/// So that no pass finds in the caches what the one before it left there.
void sweep_caches();

/// What a step answers.
struct Felt {
  Vec3 force{};
  std::uint32_t status = 0;
  bool operator==(const Felt&) const = default;
};

/// A pass over the steps, the time of each by itself.
struct Pass {
  std::vector<std::int64_t> ns;
  std::vector<Felt> felt;
};

inline std::int64_t since(Clock::time_point start) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count();
}

template <typename Step>
Pass timed_pass(const std::vector<Vec3>& tips, Step step) {
  Pass pass{std::vector<std::int64_t>(tips.size()), std::vector<Felt>(tips.size())};
  sweep_caches();
  for (std::size_t i = 0; i < tips.size(); ++i) {
    const auto start = Clock::now();
    const Felt felt = step(tips[i]);
    pass.ns[i] = since(start);
    pass.felt[i] = felt;
  }
  return pass;
}

/// Counters median, p99 and p999 (99.9 %), ns, with `which` appended to their names.
void count_quantiles(benchmark::State& state, std::vector<std::int64_t> times,
                     const std::string& which);

/// One pass an iteration; `begin` makes what steps, afresh. Returns the first pass.
template <typename Begin>
Pass time_passes(benchmark::State& state, const Begin& begin, Motion motion = Motion::Both) {
  const std::vector<Vec3> tips = trajectory(motion);
  Pass first;
  std::vector<std::int64_t> least;
  for (auto _ : state) {
    const Pass pass = timed_pass(tips, begin());
    double sum = 0;
    for (const std::int64_t ns : pass.ns) sum += static_cast<double>(ns);
    state.SetIterationTime(1e-9 * sum / static_cast<double>(tips.size()));
    if (least.empty()) {
      first = pass;
      least = pass.ns;
    }
    if (pass.felt != first.felt) {
      state.SkipWithError("two passes differ in a force or a status");
      break;
    }
    for (std::size_t i = 0; i < least.size(); ++i) least[i] = std::min(least[i], pass.ns[i]);
  }
  count_quantiles(state, first.ns, "");
  count_quantiles(state, least, "_least");
  state.counters["clock"] = clock_cost();
  return first;
}

}  // namespace palpate::bench
