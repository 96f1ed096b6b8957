// SPDX-License-Identifier: AGPL-3.0-or-later
// The force step in sustained contact with sliding, on spheres of 512 to 500 000 triangles, and a
// control: arithmetic of always the same length without memory, timed in the same way.
//
//   bench_runtime [--benchmark_filter=...] [--benchmark_format=json]
//
// The host of a virtual machine takes the processor away for microseconds, and no count in the
// guest tells of it: the 99.9 % of the control, whose work never varies, is the machine's, and so
// is that of the step. passes.hpp says how several passes remove it.
//
// Counters, in nanoseconds: median, p99, p999 (99.9 %) of the steps of the first pass, as they
// were; median_least, p99_least, p999_least of the least times; `clock`, the median of an empty
// measurement, which is part of each figure. `Time` is the mean step of a pass.
#include <benchmark/benchmark.h>

#include <cstdint>

#include "bench/runtime/passes.hpp"
#include "bench/runtime/step_on_sphere.hpp"

namespace palpate::bench {
namespace {

constexpr int kSums = 64;  // of the control, each of which waits for the one before

void control(benchmark::State& state) {
  const auto sums = [](const Vec3& x) {
    double sum = 0;
    for (int i = 0; i < kSums; ++i) sum = 0.5 * sum + x[0];
    return Felt{{sum, 0, 0}, 0};
  };
  time_passes(state, [&] { return sums; });
}

BENCHMARK(control)->Iterations(kPasses)->UseManualTime()->Unit(benchmark::kMicrosecond);

/// n = 8, 25, 79, 250: 512, 5 000, 49 928 and 500 000 triangles; then coupled responses, both kinds
/// with three relaxation times, and coupled ones that lean and have soft axes, while the tool
/// presses and slides. Then the smallest body while it only presses, and while it only slides.
void steps(benchmark::internal::Benchmark* bench) {
  constexpr auto kBoth = static_cast<std::int64_t>(Motion::Both);
  for (const std::int64_t n : {8, 25, 79, 250}) bench->Args({n, 0, kBoth});
  for (const std::int64_t variant : {1, 4, 2, 3, 5})
    for (const std::int64_t n : {8, 79}) bench->Args({n, variant, kBoth});
  for (const Motion motion : {Motion::Press, Motion::Slide})
    for (const std::int64_t variant : {0, 1, 4, 2, 3, 5})
      bench->Args({8, variant, static_cast<std::int64_t>(motion)});
}

BENCHMARK(step_on_sphere)
    ->Apply(steps)
    ->ArgNames({"n", "responses", "motion"})
    ->Iterations(kPasses)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace palpate::bench

BENCHMARK_MAIN();
