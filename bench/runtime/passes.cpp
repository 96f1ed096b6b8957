// SPDX-License-Identifier: AGPL-3.0-or-later
#include "bench/runtime/passes.hpp"

#include <unistd.h>

#include <cmath>

#include "bench/runtime/octasphere.hpp"

namespace palpate::bench {
namespace {

constexpr double kSpeed = 0.1;         // m/s over the surface
constexpr double kMeanRadius = 0.047;  // m: 3 mm deep

Vec3 tip(int step, Motion motion) {
  const auto angle_at = [](int at) { return kSpeed / kRate * at / kMeanRadius; };
  const double angle = angle_at(motion == Motion::Press ? 1 : step);
  const double latitude = 1.2 * std::sin(angle / 17.3);
  const double swing = motion == Motion::Slide ? 0 : std::sin(7 * angle_at(step));
  const double r = kMeanRadius + 0.0015 * swing;
  return r * Vec3{std::cos(angle) * std::cos(latitude), std::sin(angle) * std::cos(latitude),
                  std::sin(latitude)};
}

}  // namespace

std::vector<Vec3> trajectory(Motion motion) {
  std::vector<Vec3> tips;
  tips.reserve(kSteps);
  for (int i = 0; i < kSteps; ++i) tips.push_back(tip(i, motion));
  return tips;
}

Vec3 outside() {
  return 1.1 * tip(1, Motion::Both);
}

std::vector<Vec3> approach() {
  constexpr int kApproach = 100;
  const Vec3 end = tip(0, Motion::Press);
  std::vector<Vec3> tips;
  for (int i = 0; i < kApproach; ++i)
    tips.push_back((1 + (kOctasphereRadius / norm(end) - 1) * (kApproach - i) / kApproach) * end);
  return tips;
}

double clock_cost() {
  std::vector<std::int64_t> cost(10001);
  for (std::int64_t& c : cost) c = since(Clock::now());
  std::nth_element(cost.begin(), cost.begin() + 5000, cost.end());
  return static_cast<double>(cost[5000]);
}

void sweep_caches() {
  const auto caches = static_cast<std::size_t>(std::max(sysconf(_SC_LEVEL3_CACHE_SIZE), 1L << 26));
  static std::vector<char> other(caches);
  for (std::size_t i = 0; i < other.size(); i += 64) ++other[i];
  benchmark::ClobberMemory();
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

}  // namespace palpate::bench
