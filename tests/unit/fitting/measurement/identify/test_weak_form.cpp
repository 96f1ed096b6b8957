// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/identify/weak_form.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace palpate::identify {
namespace {

/// x = 3 + 20 t + sin(90 t) mm along y, sampled unevenly at about 1 kHz; the force is constant from
/// each sample on.
MotionRecord sine() {
  MotionRecord record;
  record.axis = 1;
  for (int i = 0; i < 400; ++i) {
    const double t = 1e-3 * i + 1e-4 * std::sin(1.7 * i);
    record.time.push_back(t);
    record.position.push_back({0, 1e-3 * (3 + 20 * t + std::sin(90 * t)), 0});
    record.command.push_back({0, static_cast<double>(i % 7), 0});
  }
  return record;
}

/// Integral of phi(t) f(t) over a window, by fine midpoints.
template <class F>
double fine_integral(const Window& w, F f) {
  constexpr int kPoints = 200000;
  const double length = w.end - w.begin;
  double sum = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double s = (i + 0.5) / kPoints;
    const double p = s * (1 - s);
    sum += 1024 * p * p * p * p * p * f(w.begin + s * length);
  }
  return sum * length / kPoints;
}

TEST(TestFunction, IntegratesDerivativesOfThePositionWithoutDifferences) {
  const MotionRecord record = sine();
  for (const Window& w : {Window{0.1, 0.15, 1}, Window{0.2032, 0.2351, 1}}) {
    const TestFunction phi(w);
    EXPECT_NEAR(phi.integral(), fine_integral(w, [](double) { return 1.0; }), 1e-9);
    const auto position = [](double t) { return 1e-3 * (3 + 20 * t + std::sin(90 * t)); };
    const auto speed = [](double t) { return 1e-3 * (20 + 90 * std::cos(90 * t)); };
    const auto acceleration = [](double t) { return -8.1 * std::sin(90 * t); };
    EXPECT_NEAR(phi.integral_of(record, 1, 0), fine_integral(w, position), 1e-7 * phi.integral());
    EXPECT_NEAR(-phi.integral_of(record, 1, 1), fine_integral(w, speed), 2e-5 * phi.integral());
    EXPECT_NEAR(phi.integral_of(record, 1, 2), fine_integral(w, acceleration),
                5e-3 * phi.integral());
    EXPECT_EQ(phi.integral_of(record, 0, 2), 0);  // it does not move along x
  }
}

/// A delay that is no multiple of the period: the commands are steps in time, shifted.
TEST(TestFunction, IntegratesTheCommandThatActsLater) {
  const MotionRecord record = sine();
  const Window w{0.15, 0.19, 1};
  for (const double delay : {0.0, 0.0004, 0.0137}) {
    const auto acting = [&](double t) {
      std::size_t i = 0;
      while (i + 1 < record.time.size() && record.time[i + 1] + delay <= t) ++i;
      return record.command[i][1];
    };
    EXPECT_NEAR(TestFunction(w).integral_of_command(record, 1, delay), fine_integral(w, acting),
                1e-6)
        << delay;
  }
}

TEST(OneWayWindows, LieBetweenTurningPoints) {
  MotionRecord record;
  constexpr double kOmega = 2 * std::numbers::pi * 4;  // turning points at multiples of 1/8 s
  for (int i = 0; i < 1000; ++i) {
    record.time.push_back(1e-3 * i);
    record.position.push_back({std::cos(kOmega * 1e-3 * i), 0, 0});
    record.command.push_back({});
  }
  const std::vector<Window> windows = one_way_windows(record, 0.2);
  ASSERT_EQ(windows.size(), 19U);  // three in each of six swings, and one in the rest of another
  for (const Window& w : windows) {
    EXPECT_GE(w.begin, 0.2);
    EXPECT_EQ(std::floor(8 * w.begin), std::floor(8 * w.end)) << w.begin;
    EXPECT_EQ(w.direction, std::sin(kOmega * (w.begin + w.end) / 2) > 0 ? -1 : 1) << w.begin;
    EXPECT_LE(w.end - w.begin, 0.06);
  }
}

TEST(SmoothVelocity, IsThatOfALineAndLittleDisturbedBySteps) {
  MotionRecord record;
  for (int i = 0; i < 100; ++i) {
    record.time.push_back(1e-3 * i);
    record.position.push_back({0, 0, 1e-5 * std::round(1e5 * 0.05 * 1e-3 * i)});
  }
  for (const double v : smooth_velocity(record, 2)) EXPECT_NEAR(v, 0.05, 0.002);
}

}  // namespace
}  // namespace palpate::identify
