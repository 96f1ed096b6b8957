// SPDX-License-Identifier: AGPL-3.0-or-later
// The motion of one axis against closed forms, energy and an independent integrator.
#include "runtime/devices/axis_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace palpate::runtime {
namespace {

/// Runge-Kutta of the smooth equation (no dry friction), in many small steps.
AxisState integrate(const AxisLaw& law, AxisState s, double dt) {
  const auto rate = [&](double t, double x, double v) {
    return (law.force - law.damping * v +
            law.hand_stiffness * (law.target + law.target_velocity * t - x) +
            law.hand_damping * (law.target_velocity - v)) /
           law.mass;
  };
  const int n = 2000;
  const double h = dt / n;
  for (int i = 0; i < n; ++i) {
    const double t = i * h;
    const double k1 = rate(t, s.position, s.velocity);
    const double v2 = s.velocity + h / 2 * k1;
    const double k2 = rate(t + h / 2, s.position + h / 2 * s.velocity, v2);
    const double v3 = s.velocity + h / 2 * k2;
    const double k3 = rate(t + h / 2, s.position + h / 2 * v2, v3);
    const double v4 = s.velocity + h * k3;
    const double k4 = rate(t + h, s.position + h * v3, v4);
    s.position += h / 6 * (s.velocity + 2 * v2 + 2 * v3 + v4);
    s.velocity += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return s;
}

TEST(AxisMotion, AgreesWithRungeKuttaInEveryDampingRegime) {
  const double critical = 2 * std::sqrt(40 * 0.2);
  for (const double damping : {0.0, 0.3, critical, 30.0}) {
    for (const double stiffness : {0.0, 40.0}) {
      const AxisLaw law{0.2, damping, 0, stiffness, 0, 1.7, 0.05, -0.3};
      const AxisState start{0.01, 0.4};
      const AxisState exact = advance(law, start, 0.25);
      const AxisState reference = integrate(law, start, 0.25);
      EXPECT_NEAR(exact.position, reference.position, 1e-10) << damping << " " << stiffness;
      EXPECT_NEAR(exact.velocity, reference.velocity, 1e-9) << damping << " " << stiffness;
    }
  }
}

TEST(AxisMotion, ManyShortStepsEqualOneLongStep) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    AxisLaw law{0.1, 0.2,         0.3 * std::abs(any(random)), 200,
                0.5, any(random), 0.01 * any(random),          0.2 * any(random)};
    const AxisState start{0.01 * any(random), any(random)};
    const AxisState once = advance(law, start, 0.2);
    AxisState s = start;
    for (int i = 0; i < 400; ++i) {
      s = advance(law, s, 0.0005);
      law.target += law.target_velocity * 0.0005;
    }
    EXPECT_NEAR(s.position, once.position, 1e-11);
    EXPECT_NEAR(s.velocity, once.velocity, 1e-9);
  }
}

TEST(AxisMotion, DryFrictionTakesTwoSOverKFromEachHalfSwing) {
  // Undamped mass on a spring with dry friction: the turning points approach the centre by 2 S/k
  // each half period, and the motion ends inside |x| <= S/k.
  const double S = 0.05;
  const double k = 20;
  const double m = 0.08;
  AxisLaw law{m, 0, S, k, 0, 0, 0, 0};
  const double half_period = std::numbers::pi * std::sqrt(m / k);
  AxisState s{-0.0203, 0};
  for (int swing = 1; swing <= 3; ++swing) {
    s = advance(law, s, half_period);
    const double expected = (swing % 2 == 0 ? -1 : 1) * (0.0203 - swing * 2 * S / k);
    EXPECT_NEAR(s.position, expected, 1e-12);
    EXPECT_NEAR(s.velocity, 0, 1e-7);
  }
  s = advance(law, s, 100);
  EXPECT_EQ(s.velocity, 0);
  EXPECT_LE(std::abs(s.position), S / k);
  EXPECT_NEAR(s.position, -(0.0203 - 4 * 2 * S / k), 1e-12);  // the fourth turn is on the left
}

TEST(AxisMotion, RestsUntilTheSpringOvercomesDryFriction) {
  // The target leaves at 0.01 m/s: the mass breaks away when k p = S, after 0.25 s.
  const AxisLaw law{0.1, 0, 0.05, 20, 0, 0, 0, 0.01};
  EXPECT_EQ(advance(law, {0, 0}, 0.249).position, 0);
  EXPECT_GT(advance(law, {0, 0}, 0.26).position, 0);
  // From there: m x'' = k v t  ->  x = v (t - sin(w t)/w).
  const double w = std::sqrt(20 / 0.1);
  EXPECT_NEAR(advance(law, {0, 0}, 0.30).position, 0.01 * (0.05 - std::sin(w * 0.05) / w), 1e-14);
}

TEST(AxisMotion, EnergyBalancesToRounding) {
  // Dry friction and a constant force: work of the force = kinetic energy + S times the path.
  const AxisLaw law{0.1, 0, 0.2, 0, 0, 1.0, 0, 0};
  const AxisState s = advance(law, {0, 0}, 0.3);
  EXPECT_NEAR(1.0 * s.position, 0.05 * s.velocity * s.velocity + 0.2 * s.position, 1e-14);
  // A force below the friction moves nothing.
  AxisLaw weak = law;
  weak.force = 0.19;
  EXPECT_EQ(advance(weak, {0, 0}, 10).position, 0);
}

}  // namespace
}  // namespace palpate::runtime
