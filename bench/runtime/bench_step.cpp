// SPDX-License-Identifier: AGPL-3.0-or-later
// The force step in sustained contact with sliding, on spheres of 512 to 500 000 triangles, and a
// control: arithmetic of always the same length without memory, timed in the same way.
//
//   bench_runtime [--benchmark_filter=...] [--benchmark_format=json]
//
// The host of a virtual machine takes the processor away for microseconds, and no count in the
// guest tells of it: there the 99.9 % of the control, whose work never varies, is the machine's,
// and so is that of the step. Several passes along one trajectory, each with a fresh state and
// swept caches, do the same work at the same step (their forces are checked to be equal), and
// hardly ever does an interrupt meet the same step in all of them. The least time of each step over
// the passes is what it takes where nothing interferes: a lower bound, as it is also the luckiest
// of them.
//
// Counters, in nanoseconds: median, p99, p999 (99.9 %) of the steps of the first pass, as they
// were; median_least, p99_least, p999_least of the least times; `clock`, the median of an empty
// measurement, which is part of each figure. `Time` is the mean step of a pass.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/runtime/octasphere.hpp"
#include "runtime/handles.hpp"
#include "runtime/palpate.h"

namespace palpate::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kRate = 1000;         // Hz
constexpr double kSpeed = 0.1;         // m/s over the surface
constexpr double kMeanRadius = 0.047;  // m: 3 mm deep
constexpr int kSteps = 200000;
constexpr int kPasses = 5;
constexpr int kSums = 64;  // of the control, each of which waits for the one before

/// The libraries are large; each is made once.
const palpate_library& body_of(int n, ResponseKind kind) {
  static std::map<std::pair<int, ResponseKind>, std::unique_ptr<palpate_library>> made;
  auto& body = made[{n, kind}];
  if (!body) body = std::make_unique<palpate_library>(octasphere(n, kind));
  return *body;
}

/// A curve that winds over the whole sphere, 1.5 to 4.5 mm deep.
Vec3 tip(int step) {
  const double way = kSpeed / kRate * step;
  const double angle = way / kMeanRadius;
  const double latitude = 1.2 * std::sin(angle / 17.3);
  const double r = kMeanRadius + 0.0015 * std::sin(7 * angle);
  return r * Vec3{std::cos(angle) * std::cos(latitude), std::sin(angle) * std::cos(latitude),
                  std::sin(latitude)};
}

std::vector<Vec3> trajectory() {
  std::vector<Vec3> tips;
  tips.reserve(kSteps);
  for (int i = 0; i < kSteps; ++i) tips.push_back(tip(i));
  return tips;
}

std::int64_t since(Clock::time_point start) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count();
}

double clock_cost() {
  std::vector<std::int64_t> cost(10001);
  for (std::int64_t& c : cost) c = since(Clock::now());
  std::nth_element(cost.begin(), cost.begin() + 5000, cost.end());
  return static_cast<double>(cost[5000]);
}

/// So that no pass finds in the caches what the one before it left there.
void sweep_caches() {
  const auto caches = static_cast<std::size_t>(std::max(sysconf(_SC_LEVEL3_CACHE_SIZE), 1L << 26));
  static std::vector<char> other(caches);
  for (std::size_t i = 0; i < other.size(); i += 64) ++other[i];
  benchmark::ClobberMemory();
}

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

void count_quantiles(benchmark::State& state, std::vector<std::int64_t> times,
                     const std::string& which) {
  std::sort(times.begin(), times.end());
  const auto quantile = [&](double share) {
    const double rank = share * static_cast<double>(times.size() - 1);
    return static_cast<double>(times[static_cast<std::size_t>(rank)]);
  };
  state.counters["median" + which] = quantile(0.5);
  state.counters["p99" + which] = quantile(0.99);
  state.counters["p999" + which] = quantile(0.999);
}

/// One pass an iteration; `begin` makes what steps, afresh. Returns the first pass.
template <typename Begin>
Pass time_passes(benchmark::State& state, const Begin& begin) {
  const std::vector<Vec3> tips = trajectory();
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

void control(benchmark::State& state) {
  const auto sums = [](const Vec3& x) {
    double sum = 0;
    for (int i = 0; i < kSums; ++i) sum = 0.5 * sum + x[0];
    return Felt{{sum, 0, 0}, 0};
  };
  time_passes(state, [&] { return sums; });
}

void step_on_sphere(benchmark::State& state) {
  const auto kind = state.range(1) == 0 ? ResponseKind::Decoupled : ResponseKind::Coupled;
  const palpate_library& body = body_of(static_cast<int>(state.range(0)), kind);
  std::unique_ptr<palpate_state> tool;
  const auto step = [&](const Vec3& x) {
    static constexpr double kVelocity[3] = {0, 0, 0};
    Felt felt;
    felt.status = palpate_step(tool.get(), x.data(), kVelocity, 1 / kRate, felt.force.data());
    return felt;
  };
  const Pass pass = time_passes(state, [&] {
    tool = std::make_unique<palpate_state>(
        body, runtime::ContactSettings{.friction = 0.3, .tank_cap = 5e-3, .lipschitz_bound = 1200});
    step((0.052 / norm(tip(0))) * tip(0));  // from outside
    return step;
  });
  const auto sliding = std::count_if(pass.felt.begin(), pass.felt.end(), [](const Felt& felt) {
    return (felt.status & PALPATE_SLIDING) != 0;
  });
  state.counters["triangles"] = static_cast<double>(8 * state.range(0) * state.range(0));
  state.counters["sliding"] = static_cast<double>(sliding) / kSteps;
}

BENCHMARK(control)->Iterations(kPasses)->UseManualTime()->Unit(benchmark::kMicrosecond);

// n = 8, 25, 79, 250: 512, 5 000, 49 928 and 500 000 triangles; then coupled responses.
BENCHMARK(step_on_sphere)
    ->Args({8, 0})
    ->Args({25, 0})
    ->Args({79, 0})
    ->Args({250, 0})
    ->Args({8, 1})
    ->Args({79, 1})
    ->Iterations(kPasses)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace palpate::bench

BENCHMARK_MAIN();
