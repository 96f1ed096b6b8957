// SPDX-License-Identifier: AGPL-3.0-or-later
// palpate_deform on a sphere of 10 002 skin vertices, alone and beside a force loop of 4 kHz.
//
//   bench_deform [--benchmark_filter=...]
//
// Counter `late`, beside the loop: its steps that began more than half a period after their time,
// in a thousand. The same of a loop without pictures is `late_alone`: what the machine does.
#include <benchmark/benchmark.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <thread>
#include <vector>

#include "bench/runtime/octasphere.hpp"
#include "format/deformation.hpp"
#include "runtime/handles.hpp"
#include "runtime/skin_deformation.hpp"

namespace palpate::bench {
namespace {

constexpr int kSplit = 50;  // 20 000 triangles
constexpr double kDepth = 0.004, kRadius = 0.008, kSphere = 0.05;
constexpr std::size_t kKnots = 24;
constexpr auto kPeriod = std::chrono::microseconds(250);

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

/// Steps at their times until told to end. @return late steps in a thousand
double run_loop(Scene& scene, const std::atomic<bool>& over) {
  std::int64_t steps = 0, late = 0;
  auto due = std::chrono::steady_clock::now();
  while (!over || steps == 0) {
    due += kPeriod;
    std::this_thread::sleep_until(due);
    late += std::chrono::steady_clock::now() - due > kPeriod / 2 ? 1 : 0;
    scene.step(2.5e-4 * static_cast<double>(++steps));
  }
  return 1e3 * static_cast<double>(late) / static_cast<double>(steps);
}

template <class Work>
double late_beside(Scene& scene, const Work& work) {
  std::atomic<bool> over{false};
  double late = 0;
  std::thread loop([&] { late = run_loop(scene, over); });
  work();
  over = true;
  loop.join();
  return late;
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

void deform_beside_a_loop(benchmark::State& state) {
  Scene scene(static_cast<std::size_t>(state.range(0)));
  std::vector<Vec3> x(scene.skin.positions().size());
  state.counters["late_alone"] =
      late_beside(scene, [] { std::this_thread::sleep_for(std::chrono::seconds(1)); });
  state.counters["late"] = late_beside(scene, [&] {
    for (auto _ : state) {
      scene.skin.displace(scene.state.touch(), x.front().data());
      benchmark::DoNotOptimize(x.data());
      state.PauseTiming();
      std::this_thread::sleep_for(std::chrono::milliseconds(16));
      state.ResumeTiming();
    }
  });
}

BENCHMARK(deform)->Arg(60)->Arg(200)->Unit(benchmark::kMillisecond);
BENCHMARK(deform_beside_a_loop)->Arg(60)->Arg(200)->Iterations(120)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace palpate::bench

BENCHMARK_MAIN();
