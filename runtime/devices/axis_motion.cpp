// SPDX-License-Identifier: Apache-2.0
#include "runtime/devices/axis_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "format/numbers.hpp"

namespace palpate::runtime {
namespace {

constexpr double kStandstill = 1e-15;  // m/s; slower is rounding, not motion
constexpr int kMostEvents = 256;       // stops and breakaways in one sample

/// exp(-a t) cos(w t) and exp(-a t) sin(w t)/w for w^2 = square, continued to square <= 0.
struct Mode {
  double cosine = 1, sine = 0;
};

Mode mode(double decay, double square, double t) noexcept {
  if (square > 0) {
    const double w = std::sqrt(square);
    const double e = std::exp(-decay * t);
    return {e * std::cos(w * t), e * std::sin(w * t) / w};
  }
  const double w = std::sqrt(-square);
  const double slow = std::exp((w - decay) * t);  // of the two decaying exponentials
  const double ratio = std::exp(-2 * w * t);
  const double sine = w * t > 1e-8 ? slow * (1 - ratio) / (2 * w) : slow * t;
  return {slow * (1 + ratio) / 2, sine};
}

/// (1 - exp(-z))/z and (z - 1 + exp(-z))/z^2, z >= 0.
double phi1(double z) noexcept {
  return z > 0 ? -std::expm1(-z) / z : 1.0;
}
double phi2(double z) noexcept {
  if (z > 0.05) return (z + std::expm1(-z)) / (z * z);
  double term = 0.5;
  double sum = term;
  for (int n = 3; n < 12; ++n) {
    term *= -z / n;
    sum += term;
  }
  return sum;
}

/// Motion in one direction: linear, with the dry friction a constant force.
class Glide {
 public:
  Glide(const AxisLaw& law, const AxisState& start, double direction) noexcept
      : m_(law.mass), c_(law.damping + law.hand_damping), k_(law.hand_stiffness), start_(start) {
    const double push =
        law.force - direction * law.coulomb_friction + law.hand_damping * law.target_velocity;
    acceleration_ = (push + k_ * (law.target - start.position) - c_ * start.velocity) / m_;
    drift_ = law.target_velocity;
    push_ = push;
    if (k_ > 0) lead_ = (push - c_ * drift_) / k_ + law.target;
    decay_ = c_ / (2 * m_);
    square_ = k_ / m_ - decay_ * decay_;
  }

  AxisState at(double t) const noexcept {
    if (k_ > 0) return on_spring(t);
    const double z = c_ / m_ * t;
    return {start_.position + t * (start_.velocity * phi1(z) + push_ / m_ * t * phi2(z)),
            start_.velocity * std::exp(-z) + push_ / m_ * t * phi1(z)};
  }

  /// First zero of the acceleration after t = 0, and the time from one zero to the next.
  double first_turn() const noexcept {
    if (!(k_ > 0)) return kInfinity;  // the velocity approaches its limit from one side
    const double jerk = -(c_ * acceleration_ + k_ * (start_.velocity - drift_)) / m_;
    const double b = jerk + decay_ * acceleration_;  // a(t) = a0 cosine + b sine
    if (square_ > 0) {
      const double w = std::sqrt(square_);
      const double angle = std::atan2(-acceleration_ * w, b);
      const double folded = angle > 0 ? angle : angle + std::numbers::pi;
      return folded / w;
    }
    const double w = std::sqrt(-square_);
    const double ratio = -acceleration_ / b;  // tanh(w t)/w at the zero
    if (!(ratio > 0) || !(ratio * w < 1)) return kInfinity;
    return w > 0 ? std::atanh(ratio * w) / w : ratio;
  }
  double between_turns() const noexcept {
    return square_ > 0 ? std::numbers::pi / std::sqrt(square_) : kInfinity;
  }

 private:
  AxisState on_spring(double t) const noexcept {
    const Mode e = mode(decay_, square_, t);
    const double y = start_.position - lead_;
    const double w = start_.velocity - drift_;
    return {lead_ + drift_ * t + y * e.cosine + (w + decay_ * y) * e.sine,
            drift_ + w * e.cosine - (decay_ * w + k_ / m_ * y) * e.sine};
  }

  double m_, c_, k_;
  AxisState start_;
  double acceleration_ = 0;
  double drift_ = 0;
  double push_ = 0;
  double lead_ = 0;  ///< equilibrium of the mass at t = 0 if it moved with the target
  double decay_ = 0;
  double square_ = 0;
};

/// The instant in [before, after] at which the velocity, monotone there, changes sign.
double stop_between(const Glide& glide, double direction, double before, double after) noexcept {
  for (int i = 0; i < 200; ++i) {
    const double middle = before + (after - before) / 2;
    if (middle <= before || middle >= after) break;
    (direction * glide.at(middle).velocity >= 0 ? before : after) = middle;
  }
  return after;
}

/// First instant in (0, dt] at which the motion turns against its direction; infinity if none.
double first_stop(const Glide& glide, double direction, double dt) noexcept {
  double before = 0;
  double turn = glide.first_turn();
  while (before < dt) {
    const double after = std::min(turn, dt);
    if (direction * glide.at(after).velocity < -kStandstill) {
      return stop_between(glide, direction, before, after);
    }
    before = after;
    turn += glide.between_turns();
  }
  return kInfinity;
}

/// Applied force on the mass at rest and its rate.
double net_force(const AxisLaw& law, double x) noexcept {
  return law.force + law.hand_stiffness * (law.target - x) + law.hand_damping * law.target_velocity;
}

/// How long a mass at rest stays at rest.
double rest_duration(const AxisLaw& law, double x) noexcept {
  const double net = net_force(law, x);
  const double rate = law.hand_stiffness * law.target_velocity;
  if (rate == 0) return kInfinity;
  return std::max(0.0, (std::copysign(law.coulomb_friction, rate) - net) / rate);
}

void pass(AxisLaw& law, double t) noexcept {
  law.target += law.target_velocity * t;
}

}  // namespace

AxisState advance(const AxisLaw& start_law, const AxisState& start, double dt) noexcept {
  AxisLaw law = start_law;
  AxisState now = start;
  double left = dt;
  if (law.coulomb_friction <= 0) return Glide(law, now, 0).at(left);
  for (int event = 0; event < kMostEvents && left > 0; ++event) {
    double direction = now.velocity;
    if (std::abs(now.velocity) <= kStandstill) {
      now.velocity = 0;
      direction = net_force(law, now.position);
      if (std::abs(direction) <= law.coulomb_friction) {
        const double rest = rest_duration(law, now.position);
        if (rest >= left) return now;
        pass(law, rest);
        left -= rest;
        direction = law.target_velocity;
      }
    }
    direction = std::copysign(1.0, direction);
    const Glide glide(law, now, direction);
    const double stop = first_stop(glide, direction, left);
    if (stop >= left) return glide.at(left);
    now = {glide.at(stop).position, 0};
    pass(law, stop);
    left -= stop;
  }
  return now;
}

}  // namespace palpate::runtime
