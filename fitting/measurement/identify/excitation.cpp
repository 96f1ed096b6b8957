// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/identify/excitation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate::identify {
namespace {

constexpr int kSines = 8;
constexpr double kLowest = 1.5, kHighest = 20;  // Hz
constexpr double kSpring = 0.25;                // of the largest force, at the border of the box
constexpr double kGrow = 0.3, kShrink = 8;      // 1/s, of the gain
constexpr double kFade = 0.5;                   // s
constexpr double kRoom = 0.5;                   // of the box: the amplitude grows within

double frequency(int i) {
  return kLowest * std::pow(kHighest / kLowest, i / (kSines - 1.0));
}

}  // namespace

/// At most 1. Phases by Schroeder, so that the peaks of the sines do not meet.
double Excitation::sines(double time) const noexcept {
  double sum = 0, weights = 0;
  for (int i = 0; i < kSines; ++i) {
    const double phase = std::numbers::pi * i * i / kSines;
    sum += frequency(i) * std::sin(2 * std::numbers::pi * frequency(i) * time + phase);
    weights += frequency(i);
  }
  return sum / weights;
}

void Excitation::adapt(double time, double way) noexcept {
  const double dt = time - last_;
  last_ = time;
  const double rate = way < kRoom * settings_.box ? kGrow : -kShrink;
  const double left = settings_.seconds - time;
  gain_ = std::clamp(gain_ + rate * dt, 0.0, std::clamp(left / kFade, 0.0, 1.0));
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
  adapt(time - begin_, std::abs(away[settings_.axis]));
  const double limit = settings_.max_force;
  Vec3 force = -(kSpring * limit / settings_.box) * away;
  force[settings_.axis] += gain_ * limit * sines(time - begin_);
  for (double& component : force) component = std::clamp(component, -limit, limit);
  return force;
}

}  // namespace palpate::identify
