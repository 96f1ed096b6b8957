// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/safety.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "format/error.hpp"
#include "runtime/palpate.h"

namespace palpate::test {
namespace {

using runtime::Safety;
using runtime::SafetySettings;

constexpr double kDt = 1e-3;
const Vec3 kStill{};

/// Past the ramp.
Safety ready(SafetySettings settings) {
  Safety safety(settings);
  for (int i = 0; i < 2000; ++i) safety.judge({}, kStill, kDt);
  return safety;
}

TEST(Safety, LetsAnOrdinaryForceThroughUntouched) {
  Safety safety = ready({0.5, 5, 3, 0.02});
  const auto verdict = safety.judge({1, -2, 3}, {0.1, 0, 0}, kDt);
  EXPECT_EQ(verdict.force, (Vec3{1, -2, 3}));
  EXPECT_EQ(verdict.status, 0U);
}

TEST(Safety, WhatIsNoNumberBecomesNoForce) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  Safety safety = ready({0.5, 5, 3, 0.02});
  for (const Vec3& bad : {Vec3{nan, 0, 0}, Vec3{0, infinity, 0}, Vec3{0, 1, -infinity}}) {
    const auto verdict = safety.judge(bad, kStill, kDt);
    EXPECT_EQ(verdict.force, Vec3{});
    EXPECT_EQ(verdict.status, PALPATE_LOOP_NOT_FINITE);
  }
  // A velocity that is no number cannot be told to be slow: cut off.
  EXPECT_EQ(safety.judge({1, 0, 0}, {nan, 0, 0}, kDt).status, PALPATE_LOOP_TOO_FAST);
  // Nor can a time.
  EXPECT_TRUE(ready({}).judge({1, 0, 0}, kStill, nan).status & PALPATE_LOOP_LATE);
}

TEST(Safety, TheClampKeepsTheDirection) {
  Safety safety = ready({0.5, 5, 3, 0.02});
  const Vec3 force{30, -40, 120};
  const auto verdict = safety.judge(force, kStill, kDt);
  EXPECT_EQ(verdict.status, PALPATE_LOOP_CLAMPED);
  EXPECT_NEAR(norm(verdict.force), 5, 1e-12);
  EXPECT_NEAR(norm(cross(verdict.force, force)), 0, 1e-10);
  EXPECT_GT(dot(verdict.force, force), 0);
}

TEST(Safety, TheForceIsLetInOverTheRamp) {
  Safety safety({0.5, 100, 3, 0.02});
  double last = 0;
  for (int i = 1; i <= 600; ++i) {
    const auto verdict = safety.judge({2, 0, 0}, kStill, kDt);
    EXPECT_NEAR(verdict.force[0], 2 * std::min(1.0, i * kDt / 0.5), 1e-9);
    EXPECT_GE(verdict.force[0], last);
    EXPECT_EQ((verdict.status & PALPATE_LOOP_RAMPING) != 0, verdict.force[0] < 2);
    last = verdict.force[0];
  }
}

TEST(Safety, TooFastCutsOffUntilSlowAndRampsAnew) {
  Safety safety = ready({0.1, 100, 2, 0.02});
  EXPECT_EQ(safety.judge({1, 0, 0}, {0, 1.9, 0}, kDt).force[0], 1);
  EXPECT_EQ(safety.judge({1, 0, 0}, {0, 2.1, 0}, kDt).status, PALPATE_LOOP_TOO_FAST);
  EXPECT_EQ(safety.judge({1, 0, 0}, {0, 1.1, 0}, kDt).force[0], 0);  // not slow enough yet
  const auto after = safety.judge({1, 0, 0}, {0, 0.9, 0}, kDt);
  EXPECT_NEAR(after.force[0], 0.01, 1e-12);
  EXPECT_EQ(after.status, PALPATE_LOOP_RAMPING);
}

TEST(Safety, AGapCutsOffAndRampsAnew) {
  Safety safety = ready({0.1, 100, 2, 0.02});
  const auto late = safety.judge({1, 0, 0}, kStill, 0.021);
  EXPECT_EQ(late.force, Vec3{});
  EXPECT_EQ(late.status, PALPATE_LOOP_LATE);
  EXPECT_NEAR(safety.judge({1, 0, 0}, kStill, kDt).force[0], 0.01, 1e-12);
}

TEST(Safety, RefusesSettingsOutOfRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const SafetySettings& bad :
       {SafetySettings{-1, 5, 3, 1}, SafetySettings{nan, 5, 3, 1}, SafetySettings{1, 0, 3, 1},
        SafetySettings{1, nan, 3, 1}, SafetySettings{1, 5, 0, 1}, SafetySettings{1, 5, 3, 0}}) {
    EXPECT_THROW(Safety{bad}, Error);
  }
}

}  // namespace
}  // namespace palpate::test
