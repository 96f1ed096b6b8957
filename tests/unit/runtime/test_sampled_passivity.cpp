// SPDX-License-Identifier: AGPL-3.0-or-later
// The theorem of docs/theory-certificate.md is attained by a linear wall on the exact simulated
// device. test_adversary.cpp searches rendered bodies for motions that break it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <random>
#include <utility>

#include "format/passivity.hpp"
#include "runtime/devices/device_simulated.hpp"

namespace palpate::test {
namespace {

using runtime::SimulatedDevice;
using Random = std::mt19937_64;

double between(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

// A linear wall on one axis

constexpr double kPeriod = 1e-3, kDamping = 0.1;

/// Stiffness that the damping certifies with this delay in samples, N/m.
double certified_stiffness(int delay) {
  if (delay == 0) return kDamping / (0.5 * kPeriod);  // Colgate & Schenkel 1997
  return certifiable_stiffness({kDamping, 0, (delay - 1) * kPeriod, 0, 0}, 1 / kPeriod, 0);
}

/// A wall that pulls as well, so that nothing but its sampling takes or gives energy. The mass is
/// so large that the oscillation is slow: 125 samples and more.
class Wall {
 public:
  Wall(double stiffness, int delay, double friction = 0)
      : stiffness_(stiffness),
        device_({.mass = 400 * stiffness * kPeriod * kPeriod,
                 .damping = kDamping,
                 .coulomb_friction = friction,
                 .delay_samples = 0}),
        commands_(static_cast<std::size_t>(delay)) {}

  void release(double x) { device_.place({x, 0, 0}, {}); }
  /// One sample with this period, of a position rounded to `resolution` and a constant push.
  void step(double period, double resolution = 0, double push = 0) {
    const double x = device_.position()[0];
    const double seen = resolution > 0 ? resolution * std::round(x / resolution) : x;
    commands_.push_back(push - stiffness_ * seen);
    device_.step(period, {commands_.front(), 0, 0});
    commands_.pop_front();
  }
  /// Largest |x| in the next samples, each of a period from `period()`.
  template <class Period>
  double amplitude(int samples, Period period) {
    double largest = 0;
    for (int i = 0; i < samples; ++i) {
      step(period());
      largest = std::max(largest, std::abs(device_.position()[0]));
    }
    return largest;
  }
  double speed() const { return std::abs(device_.velocity()[0]); }

 private:
  double stiffness_;
  SimulatedDevice device_;
  std::deque<double> commands_;
};

/// Growth of the amplitude of a free oscillation over many periods.
template <class Period>
double growth(double stiffness, int delay, Period period) {
  constexpr int kOscillation = 200, kMany = 100000;
  Wall wall(stiffness, delay);
  wall.release(0.01);
  const double before = wall.amplitude(kOscillation, period);
  wall.amplitude(kMany, period);
  return wall.amplitude(kOscillation, period) / before;
}

TEST(LinearWall, DecaysAtTheBoundAndGrowsThreePercentBeyond) {
  const auto even = [] { return kPeriod; };
  for (const int delay : {0, 1, 2}) {
    EXPECT_LT(growth(certified_stiffness(delay), delay, even), 1) << delay;
    EXPECT_GT(growth(1.03 * certified_stiffness(delay), delay, even), 2) << delay;
  }
}

TEST(LinearWall, WithUnevenSamplesIsBoundByTheLongestPeriod) {
  for (const int delay : {0, 1, 2}) {
    Random random(5);
    const auto uneven = [&] { return between(random, 0.2, 1) * kPeriod; };
    EXPECT_LT(growth(certified_stiffness(delay), delay, uneven), 1) << delay;
    // Most periods are the longest: then the bound is attained.
    const auto jitter = [&] { return (random() % 100 == 0 ? 0.5 : 1.0) * kPeriod; };
    EXPECT_LT(growth(certified_stiffness(delay), delay, jitter), 1) << delay;
    EXPECT_GT(growth(1.03 * certified_stiffness(delay), delay, jitter), 2) << delay;
    // The mean of the periods is not what counts.
    const double mean = 0.6;
    const auto mixed = [&] { return (random() % 2 == 0 ? 0.2 : 1.0) * kPeriod; };
    EXPECT_GT(growth(certified_stiffness(delay) / mean, delay, mixed), 2) << delay;
  }
}

/// Positions are late and forces come late by times that vary within a period: the largest delay
/// and three quarters of what lengthens a period count, (C11).
TEST(LinearWall, WithADelayThatVariesDecaysAtTheStiffnessOfItsBound) {
  constexpr int kFine = 10;  // parts of a period
  constexpr int kLate = 4, kSoonest = 6, kLatest = 14;
  const double fine = kPeriod / kFine;
  const double tau = (kLatest + kLate + 0.75 * kLate) * fine;
  const double stiffness = certifiable_stiffness({kDamping, 0, tau, 0, 0}, 1 / kPeriod, 0);
  for (const bool always_latest : {false, true}) {
    Random random(7);
    const auto among = [&](int low, int high) {
      return always_latest
                 ? high
                 : low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1));
    };
    SimulatedDevice device(
        {.mass = 400 * stiffness * kPeriod * kPeriod, .damping = kDamping, .delay_samples = 0});
    device.place({0.01, 0, 0}, {});
    std::deque<double> past(kLate + 1, 0.01);    // newest first
    std::deque<std::pair<long, double>> coming;  // when, which force
    double acting = 0, first = 0, last = 0;
    constexpr long kSteps = 400000;
    for (long i = 0; i < kSteps; ++i) {
      if (i % kFine == 0)
        coming.emplace_back(i + among(kSoonest, kLatest),
                            -stiffness * past[static_cast<std::size_t>(among(0, kLate))]);
      for (; !coming.empty() && coming.front().first <= i; coming.pop_front())
        acting = coming.front().second;
      device.step(fine, {acting, 0, 0});
      past.push_front(device.position()[0]);
      past.pop_back();
      double& largest = i < kSteps / 2 ? first : last;
      largest = std::max(largest, std::abs(past.front()));
    }
    EXPECT_LT(last, 0.5 * first) << always_latest;
  }
}

/// Largest speed at a sample after a long time, of a tip that a constant push holds where the
/// reported position changes.
double lasting_speed(double friction) {
  constexpr double kResolution = 1e-4;
  constexpr int kSettle = 200000, kWatch = 2000;
  const double stiffness = 0.9 * certified_stiffness(1);
  Wall wall(stiffness, 1, friction * 0.5 * stiffness * kResolution);
  wall.release(0.3 * kResolution);
  const double push = 0.5 * stiffness * kResolution;
  for (int i = 0; i < kSettle; ++i) wall.step(kPeriod, kResolution, push);
  double largest = 0;
  for (int i = 0; i < kWatch; ++i) {
    wall.step(kPeriod, kResolution, push);
    largest = std::max(largest, wall.speed());
  }
  return largest;
}

TEST(QuantizedWall, RestsWhereDryFrictionPaysForTheStepsAndOscillatesBeyond) {
  // On one axis: sigma_0(S) >= K q/2.
  EXPECT_EQ(lasting_speed(1), 0);
  EXPECT_EQ(lasting_speed(1.5), 0);
  EXPECT_GT(lasting_speed(0.97), 0);
  EXPECT_GT(lasting_speed(0.5), 10 * lasting_speed(0.97));
}

}  // namespace
}  // namespace palpate::test
