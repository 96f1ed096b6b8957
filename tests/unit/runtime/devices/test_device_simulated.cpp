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

namespace palpate::runtime {
namespace {

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
