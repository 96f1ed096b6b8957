// SPDX-License-Identifier: AGPL-3.0-or-later
// palpate_deform on a sphere of 10 002 skin vertices, alone and beside a force loop of 4 kHz.
//
//   bench_deform [--benchmark_filter=...]
//
// Beside the loop, which wakes `early_us` before its steps are due, counters of those that began
// more than half a period after their time, in a thousand, and of the latest of them in
// microseconds: alone, beside a thread that computes as long as a picture takes without using
// palpate, and beside the pictures. The three take turns of half a second, so that all meet the
// same other work of the machine. `realtime` is 1 where the loop had real-time rights. A step
// begins late because another thread has the processor, because the system or the host of a virtual
// machine wakes the loop late, or because the step before took too long. `displaced` counts the
// late steps before which the system gave the processor of the loop to another thread; `overran`
// the steps that themselves took more than half a period; `longest_us` is the longest.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bench/runtime/octasphere.hpp"
#include "format/deformation.hpp"
#include "runtime/handles.hpp"
#include "runtime/realtime.hpp"
#include "runtime/skin_deformation.hpp"

namespace palpate::bench {
namespace {

constexpr int kSplit = 50;  // 20 000 triangles
constexpr double kDepth = 0.004, kRadius = 0.008, kSphere = 0.05;
constexpr std::size_t kKnots = 24;
constexpr std::int64_t kPeriodNs = 250'000;

/// A few sites with modes of noise: the time does not depend on the numbers.
Deformation skin_of(const Library& library, std::size_t modes) {
  Deformation d;
  d.surface = surface_digest(library.positions, library.triangles);
  d.tool_shape = "sphere";
  d.tool_radius = kRadius;
  d.reach = 4 * kRadius;
  d.positions = library.positions;
  d.triangles = library.triangles;
  d.depths = {kDepth / 2, kDepth};
  d.lateral_depths = {kDepth};
  for (std::size_t j = 0; j < kKnots; ++j)
    d.knots.push_back(d.reach * static_cast<double>(j) / (kKnots - 1));
  d.donor_offset = {0};
  for (std::size_t v = 0; v < library.positions.size(); ++v) {
    d.vertex_of.push_back(static_cast<std::int32_t>(v));
    d.donor.push_back(0);
    d.donor_weight.push_back(1);
    d.donor_offset.push_back(static_cast<std::int64_t>(v) + 1);
  }
  d.sites = {{library.positions[0], library.inward[0], {0, 1, 0}}};
  d.press_local.assign(2 * kPressComponents * kKnots, 1e-4F);
  d.lateral_local.assign(kLateralComponents * kKnots, 1e-2F);
  d.press_modes.assign(2 * modes, 1e-4F);
  d.lateral_modes.assign(kTangents * modes, 1e-3F);
  d.mode_scale.assign(modes, 1e-5F);
  for (std::size_t i = 0; i < 3 * modes * d.positions.size(); ++i)
    d.modes.push_back(static_cast<std::int16_t>(i * 2654435761U >> 16));
  return d;
}

struct Scene {
  explicit Scene(std::size_t modes) : Scene(octasphere(kSplit), modes) {}
  Scene(const Library& made, std::size_t modes)
      : library(made), skin(skin_of(made, modes), made.triangles), state(library, {0.3, 5e-3}) {}

  /// The tip goes in and out of the sphere along x.
  void step(double time) {
    const double x[3] = {kSphere + 1e-4 - kDepth * std::abs(std::sin(3 * time)), 1e-4, 1e-4};
    const double still[3] = {};
    double force[3];
    palpate_step(&state, x, still, 2.5e-4, force);
  }

  palpate_library library;
  runtime::SkinDeformation skin;
  palpate_state state;
};

/// How often the system has given the processor of the calling thread to another one.
std::int64_t times_displaced() {
  rusage used{};
  getrusage(RUSAGE_THREAD, &used);
  return used.ru_nivcsw;
}

/// The lateness of the steps of a loop, and how long they took.
struct Lateness {
  std::int64_t steps = 0, late = 0, displaced = 0, worst_ns = 0, overran = 0, longest_ns = 0;

  double in_thousand() const {
    return 1e3 * static_cast<double>(late) / static_cast<double>(steps);
  }
  double worst_us() const { return 1e-3 * static_cast<double>(worst_ns); }
  double longest_us() const { return 1e-3 * static_cast<double>(longest_ns); }
};

/// Steps at their times until told to end.
/// @return whether it had real-time rights
bool run_loop(Scene& scene, std::int64_t early, const std::atomic<bool>& over, Lateness& lateness) {
  const bool realtime = runtime::become_realtime({}).empty();
  std::int64_t due = runtime::monotonic_ns(), displaced = times_displaced();
  do {
    due += kPeriodNs;
    runtime::wait_until(due, early);
    const std::int64_t begin = runtime::monotonic_ns();
    const std::int64_t displaced_before = std::exchange(displaced, times_displaced());
    lateness.worst_ns = std::max(lateness.worst_ns, begin - due);
    if (begin - due > kPeriodNs / 2) {
      ++lateness.late;
      if (displaced > displaced_before) ++lateness.displaced;
    }
    scene.step(1e-9 * static_cast<double>(kPeriodNs) * static_cast<double>(++lateness.steps));
    const std::int64_t took = runtime::monotonic_ns() - begin;
    lateness.longest_ns = std::max(lateness.longest_ns, took);
    if (took > kPeriodNs / 2) ++lateness.overran;
  } while (!over);
  return realtime;
}

/// Calls `picture` 60 times a second for half a second beside a loop. @return as run_loop().
template <class Picture>
bool beside_a_loop(Scene& scene, std::int64_t early, Lateness& lateness, const Picture& picture) {
  constexpr int kPictures = 30;
  std::atomic<bool> over{false};
  bool realtime = false;
  std::thread loop([&] { realtime = run_loop(scene, early, over, lateness); });
  for (int i = 0; i < kPictures; ++i) {
    picture();
    std::this_thread::sleep_for(std::chrono::milliseconds(16));
  }
  over = true;
  loop.join();
  return realtime;
}

void compute_for(std::chrono::nanoseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  for (double x = 1; std::chrono::steady_clock::now() < end;) benchmark::DoNotOptimize(x += 1 / x);
}

void deform(benchmark::State& state) {
  Scene scene(static_cast<std::size_t>(state.range(0)));
  std::vector<Vec3> x(scene.skin.positions().size());
  for (int i = 0; i < 100; ++i) scene.step(0.005 * i);
  for (auto _ : state) {
    scene.skin.displace(scene.state.touch(), x.front().data());
    benchmark::DoNotOptimize(x.data());
  }
  if (scene.state.touch().point.element < 0) state.SkipWithError("the tool must be in contact");
  state.counters["vertices"] = static_cast<double>(x.size());
}

/// The time is that of a picture.
void deform_beside_a_loop(benchmark::State& state) {
  using Clock = std::chrono::steady_clock;
  Scene scene(static_cast<std::size_t>(state.range(0)));
  std::vector<Vec3> x(scene.skin.positions().size());
  Lateness alone, computing, pictures;
  const std::int64_t early = 1000 * state.range(1);
  bool realtime = true;
  std::chrono::nanoseconds last{};
  for (auto _ : state) {
    std::chrono::nanoseconds spent{};
    int count = 0;
    realtime &= beside_a_loop(scene, early, alone, [] {});
    realtime &= beside_a_loop(scene, early, pictures, [&] {
      const auto begin = Clock::now();
      scene.skin.displace(scene.state.touch(), x.front().data());
      benchmark::DoNotOptimize(x.data());
      spent += Clock::now() - begin;
      ++count;
    });
    last = spent / count;
    realtime &= beside_a_loop(scene, early, computing, [&] { compute_for(last); });
    state.SetIterationTime(std::chrono::duration<double>(last).count());
  }
  state.counters["realtime"] = realtime ? 1 : 0;
  state.counters["steps"] = static_cast<double>(pictures.steps);
  for (const auto& [name, of] : {std::pair{"alone", &alone}, std::pair{"computing", &computing},
                                 std::pair{"pictures", &pictures}}) {
    state.counters[std::string("late_") + name] = of->in_thousand();
    state.counters[std::string("displaced_") + name] = static_cast<double>(of->displaced);
    state.counters[std::string("worst_us_") + name] = of->worst_us();
    state.counters[std::string("overran_") + name] = static_cast<double>(of->overran);
    state.counters[std::string("longest_us_") + name] = of->longest_us();
  }
}

BENCHMARK(deform)->ArgName("modes")->Arg(60)->Arg(200)->Unit(benchmark::kMillisecond);
BENCHMARK(deform_beside_a_loop)
    ->ArgNames({"modes", "early_us"})
    ->ArgsProduct({{60, 200}, {0, 200}})
    ->Iterations(20)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace palpate::bench

BENCHMARK_MAIN();
