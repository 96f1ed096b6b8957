// SPDX-License-Identifier: AGPL-3.0-or-later
// The force step in sustained contact with sliding, on spheres of 512 to 500 000 triangles. Every
// step is timed by itself: the median and the tail count, not the mean.
//
//   bench_runtime [--benchmark_filter=...] [--benchmark_format=json]
//
// Counters, in nanoseconds: median, p99, p999 (99.9 %) of one palpate_step, and `clock`, the median
// of an empty measurement, which is part of each figure. Steps are timed in batches; a batch during
// which the system took the processor away is not counted in these, as it says nothing of the step.
// `kept` is the share of batches that count, `p999_all` the tail with all of them.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <numbers>
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
constexpr std::size_t kBatch = 100;

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

double quantile(std::vector<std::int64_t>& sorted, double share) {
  return static_cast<double>(
      sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))]);
}

std::int64_t since(Clock::time_point start) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count();
}

/// How often the processor was taken from this thread.
long interruptions() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nivcsw + usage.ru_nvcsw;
}

double clock_cost() {
  std::vector<std::int64_t> cost(10001);
  for (std::int64_t& c : cost) c = since(Clock::now());
  std::sort(cost.begin(), cost.end());
  return quantile(cost, 0.5);
}

void step_on_sphere(benchmark::State& state) {
  const auto kind = state.range(1) == 0 ? ResponseKind::Decoupled : ResponseKind::Coupled;
  palpate_state tool(body_of(static_cast<int>(state.range(0)), kind),
                     {.friction = 0.3, .tank_cap = 5e-3, .steepness = 1200});
  std::vector<std::int64_t> all;
  std::vector<std::int64_t> spent;
  all.reserve(kSteps);
  spent.reserve(kSteps);
  std::size_t batch_start = 0;
  long before = interruptions();
  const double velocity[3] = {0, 0, 0};
  double force[3];
  int at = 0;
  std::int64_t sliding = 0;
  const Vec3 outside = (0.052 / norm(tip(0))) * tip(0);
  palpate_step(&tool, outside.data(), velocity, 1 / kRate, force);
  for (auto _ : state) {
    const Vec3 x = tip(at++);
    const auto start = Clock::now();
    const std::uint32_t status = palpate_step(&tool, x.data(), velocity, 1 / kRate, force);
    const std::int64_t ns = since(start);
    if (status & PALPATE_SLIDING) ++sliding;
    all.push_back(ns);
    if (all.size() - batch_start == kBatch) {
      const long after = interruptions();
      const auto begin = all.begin() + static_cast<std::ptrdiff_t>(batch_start);
      if (after == before) spent.insert(spent.end(), begin, all.end());
      before = after;
      batch_start = all.size();
    }
    state.SetIterationTime(1e-9 * static_cast<double>(ns));
  }
  if (spent.empty()) {
    state.SkipWithError("the processor was taken away in every batch");
    return;
  }
  const double kept = static_cast<double>(spent.size()) / static_cast<double>(all.size());
  std::sort(spent.begin(), spent.end());
  std::sort(all.begin(), all.end());
  state.counters["kept"] = kept;
  state.counters["p999_all"] = quantile(all, 0.999);
  state.counters["triangles"] = static_cast<double>(8 * state.range(0) * state.range(0));
  state.counters["median"] = quantile(spent, 0.5);
  state.counters["p99"] = quantile(spent, 0.99);
  state.counters["p999"] = quantile(spent, 0.999);
  state.counters["clock"] = clock_cost();
  state.counters["sliding"] = static_cast<double>(sliding) / static_cast<double>(all.size());
}

// n = 8, 25, 79, 250: 512, 5 000, 49 928 and 500 000 triangles; then coupled responses.
BENCHMARK(step_on_sphere)
    ->Args({8, 0})
    ->Args({25, 0})
    ->Args({79, 0})
    ->Args({250, 0})
    ->Args({8, 1})
    ->Args({79, 1})
    ->Iterations(kSteps)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace palpate::bench

BENCHMARK_MAIN();
