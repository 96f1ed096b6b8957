// SPDX-License-Identifier: AGPL-3.0-or-later
// The simulated device against mechanics: closed forms, energy, an independent integrator, and the
// published passivity margin of a discrete wall.
#include "runtime/devices/device_simulated.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "format/error.hpp"
#include "runtime/devices/axis_motion.hpp"

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

TEST(SimulatedDevice, TheCommandActsOneSampleLater) {
  SimulatedDeviceSettings settings;
  settings.damping = 0;
  SimulatedDevice late(settings);
  late.place({0, 0, 0}, {0, 0, 0});
  late.step(1e-3, {1, 0, 0});
  EXPECT_EQ(late.velocity()[0], 0);
  late.step(1e-3, {0, 0, 0});
  EXPECT_NEAR(late.velocity()[0], 1e-3 / settings.mass, 1e-15);
  settings.delay_samples = 0;
  SimulatedDevice prompt(settings);
  prompt.place({0, 0, 0}, {0, 0, 0});
  prompt.step(1e-3, {1, 0, 0});
  EXPECT_NEAR(prompt.velocity()[0], 1e-3 / settings.mass, 1e-15);
}

TEST(SimulatedDevice, RejectsConstantsOutOfRange) {
  const auto with = [](auto change) {
    SimulatedDeviceSettings s;
    change(s);
    return s;
  };
  EXPECT_THROW(SimulatedDevice(with([](auto& s) { s.mass = 0; })), Error);
  EXPECT_THROW(SimulatedDevice(with([](auto& s) { s.damping = -1; })), Error);
  EXPECT_THROW(SimulatedDevice(with([](auto& s) { s.coulomb_friction = std::nan(""); })), Error);
  EXPECT_THROW(SimulatedDevice(with([](auto& s) { s.hand_stiffness = -1; })), Error);
  EXPECT_THROW(SimulatedDevice(with([](auto& s) { s.hand_damping = -1; })), Error);
  EXPECT_THROW(SimulatedDevice(with([](auto& s) { s.delay_samples = 2; })), Error);
}

/// The published experiment: a nonlinear wall at x = 0, the device slung into it by a rubber band.
struct Sling {
  double impact = 0;       ///< m/s
  double final_swing = 0;  ///< half peak-to-peak velocity over the last half second, m/s
};
Sling sling(double k, double seconds) {
  SimulatedDevice device({0.0845, 0.081, 0.01, 20, 0, 1});
  device.place({-0.03, 0, 0}, {});
  device.set_target({0.0584, 0, 0}, {});
  const double T = 0.0005;
  Sling result;
  double low = 0;
  double high = 0;
  for (int i = 0; i < static_cast<int>(seconds / T); ++i) {
    const double x = device.position()[0];
    const double f = x <= 0 ? 0 : x <= 0.005 ? 100 * k * x * x : k * (x - 0.0025);
    if (result.impact == 0 && x > 0) result.impact = device.velocity()[0];
    device.step(T, {-f, 0, 0});
    if (i * T > seconds - 0.5) {
      low = std::min(low, device.velocity()[0]);
      high = std::max(high, device.velocity()[0]);
    }
  }
  result.final_swing = (high - low) / 2;
  return result;
}

TEST(SimulatedDevice, ReproducesThePublishedPassivityMargin) {
  // [Mahvash & Hayward 2005, VI-B]: impact near 1 m/s, decay at 168 N/m, a limit cycle at 179 N/m.
  // The two figures in m/s are those of an independent simulation with the same constants.
  EXPECT_NEAR(sling(168, 1).impact, 0.999, 1e-3);
  EXPECT_LT(sling(168, 200).final_swing, 0.002);
  EXPECT_NEAR(sling(179, 200).final_swing, 0.459, 0.001);
}

}  // namespace
}  // namespace palpate::runtime
