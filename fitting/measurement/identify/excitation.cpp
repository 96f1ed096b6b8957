// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/identify/excitation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate::identify {
namespace {

constexpr int kFrequencies = 8;
constexpr double kLowest = 1.5, kHighest = 20;  // Hz
constexpr double kSpring = 0.25;                // of the largest force, at the border of the box
constexpr double kGrow = 0.3, kShrink = 8;      // 1/s, of the gain
constexpr double kSquareGrow = 2;               // 1/s
constexpr double kFade = 0.5;                   // s
constexpr double kRoom = 0.5;                   // of the box: the amplitude grows within
constexpr double kSquareRoom = 1.5e-3;          // m: the tip is at most 0.2 m/s fast
constexpr double kSineFraction = 2.0 / 3;       // of the time
constexpr double kHalf = 0.04;                  // s, mean of the halves of the square wave

double frequency(int i) {
  return kLowest * std::pow(kHighest / kLowest, i / (kFrequencies - 1.0));
}

}  // namespace

/// At most 1. Phases by Schroeder, so that the peaks of the sines do not meet.
double Excitation::sines(double time) const noexcept {
  double sum = 0, weights = 0;
  for (int i = 0; i < kFrequencies; ++i) {
    const double phase = std::numbers::pi * i * i / kFrequencies;
    sum += frequency(i) * std::sin(2 * std::numbers::pi * frequency(i) * time + phase);
    weights += frequency(i);
  }
  return sum / weights;
}

/// The sign, from the beginning of the square wave on. Halves follow the golden ratio, which meets
/// every phase evenly; the first is half as long, so that the tip swings around its start.
double Excitation::square(double time, double way) noexcept {
  constexpr double kGolden = 0.6180339887498949;
  jumped_ = sign_ == 0 || time >= next_jump_;
  if (!jumped_) return sign_;
  const double phase = kGolden * jumps_ - std::floor(kGolden * jumps_);
  next_jump_ = time + (jumps_ == 0 ? 0.5 : 0.85 + 0.3 * phase) * kHalf;
  sign_ = sign_ > 0 ? -1 : 1;
  centre_ = way;
  ++jumps_;
  return sign_;
}

void Excitation::adapt(double time, double way) noexcept {
  const double dt = time - last_;
  last_ = time;
  const double end = sign_ == 0 ? kSineFraction * settings_.seconds : settings_.seconds;
  const double room =
      sign_ == 0 ? kRoom * settings_.box : std::min(kRoom * settings_.box, kSquareRoom);
  const double grow = sign_ == 0 ? kGrow : kSquareGrow;
  const double rate = std::abs(way - centre_) < room ? grow : -kShrink;
  gain_ = std::clamp(gain_ + rate * dt, 0.0, std::clamp((end - time) / kFade, 0.0, 1.0));
}

Vec3 Excitation::command(double time, const Vec3& x) noexcept {
  if (!begun_) {
    begun_ = true;
    start_ = x;
    begin_ = time;
  }
  const Vec3 away = x - start_;
  left_ = left_ || norm(away) > settings_.box || !is_finite(x);
  if (left_) return {};
  const double since = time - begin_, way = dot(away, settings_.direction);
  const bool sine = since < kSineFraction * settings_.seconds;
  const double wave = sine ? sines(since) : square(since, way);
  adapt(since, way);
  const double limit = settings_.max_force;
  Vec3 force =
      -(kSpring * limit / settings_.box) * away + (gain_ * limit * wave) * settings_.direction;
  for (double& component : force) component = std::clamp(component, -limit, limit);
  return force;
}

}  // namespace palpate::identify
