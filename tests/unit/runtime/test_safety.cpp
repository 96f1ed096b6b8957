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

/// A step of a tip at rest, whatever velocity the device reports.
Safety::Verdict judge(Safety& safety, const Vec3& force, const Vec3& velocity, double dt,
                      double energy = 0) {
  const Safety::Admission admission = safety.admit({{}, velocity, 0}, true, dt);
  Safety::Verdict verdict = safety.limit(force, energy);
  verdict.status |= admission.status;
  return verdict;
}

/// Past the ramp.
Safety ready(SafetySettings settings) {
  Safety safety(settings);
  for (int i = 0; i < 2000; ++i) judge(safety, {}, kStill, kDt);
  return safety;
}

TEST(Safety, LetsAnOrdinaryForceThroughUntouched) {
  Safety safety = ready({0.5, 5, 3, 0.02});
  const auto verdict = judge(safety, {1, -2, 3}, {0.1, 0, 0}, kDt);
  EXPECT_EQ(verdict.force, (Vec3{1, -2, 3}));
  EXPECT_EQ(verdict.status, 0U);
}

TEST(Safety, WhatIsNoNumberBecomesNoForce) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  Safety safety = ready({0.5, 5, 3, 0.02});
  for (const Vec3& bad : {Vec3{nan, 0, 0}, Vec3{0, infinity, 0}, Vec3{0, 1, -infinity}}) {
    const auto verdict = judge(safety, bad, kStill, kDt);
    EXPECT_EQ(verdict.force, Vec3{});
    EXPECT_EQ(verdict.status, PALPATE_LOOP_NOT_FINITE);
  }
  // A velocity that is no number cannot be told to be slow: cut off.
  EXPECT_EQ(judge(safety, {1, 0, 0}, {nan, 0, 0}, kDt).status, PALPATE_LOOP_TOO_FAST);
  // Nor can a time.
  Safety other = ready({});
  EXPECT_TRUE(judge(other, {1, 0, 0}, kStill, nan).status & PALPATE_LOOP_LATE);
}

TEST(Safety, TheClampKeepsTheDirection) {
  Safety safety = ready({0.5, 5, 3, 0.02});
  const Vec3 force{30, -40, 120};
  const auto verdict = judge(safety, force, kStill, kDt);
  EXPECT_EQ(verdict.status, PALPATE_LOOP_CLAMPED);
  EXPECT_NEAR(norm(verdict.force), 5, 1e-12);
  EXPECT_NEAR(norm(cross(verdict.force, force)), 0, 1e-10);
  EXPECT_GT(dot(verdict.force, force), 0);
}

TEST(Safety, TheForceIsLetInOverTheRamp) {
  Safety safety({0.5, 100, 3, 0.02});
  double last = 0;
  for (int i = 1; i <= 600; ++i) {
    const auto verdict = judge(safety, {2, 0, 0}, kStill, kDt);
    EXPECT_NEAR(verdict.force[0], 2 * std::min(1.0, i * kDt / 0.5), 1e-9);
    EXPECT_GE(verdict.force[0], last);
    EXPECT_EQ((verdict.status & PALPATE_LOOP_RAMPING) != 0, verdict.force[0] < 2);
    last = verdict.force[0];
  }
}

TEST(Safety, TheRampDoesNotRiseWhileEnergyIsStored) {
  // Pressed at a tenth of the force and held: leaving must return no more than was paid.
  Safety safety({0.5, 100, 3, 0.02});
  for (int i = 0; i < 50; ++i) judge(safety, {1, 0, 0}, kStill, kDt);
  const double pressed = judge(safety, {1, 0, 0}, kStill, kDt, 1e-3).force[0];
  EXPECT_NEAR(pressed, 0.1, 1e-9);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(judge(safety, {1, 0, 0}, kStill, kDt, 1e-3).force[0], pressed);
  }
  for (int i = 0; i < 1000; ++i) judge(safety, {1, 0, 0}, kStill, kDt);
  EXPECT_EQ(judge(safety, {1, 0, 0}, kStill, kDt, 1e-3).force[0], 1);
}

TEST(Safety, TooFastCutsOffUntilSlow) {
  Safety safety = ready({0.1, 100, 2, 0.02});
  EXPECT_EQ(judge(safety, {1, 0, 0}, {0, 1.9, 0}, kDt).force[0], 1);
  EXPECT_EQ(safety.admit({{}, {0, 2.1, 0}, 0}, true, kDt).action, Safety::Action::Suspend);
  EXPECT_EQ(safety.limit({1, 0, 0}, 0).force, Vec3{});
  EXPECT_EQ(judge(safety, {1, 0, 0}, {0, 1.1, 0}, kDt).status, PALPATE_LOOP_TOO_FAST);
  EXPECT_EQ(judge(safety, {1, 0, 0}, {0, 1.1, 0}, kDt).force[0], 0);  // not slow enough yet
  EXPECT_EQ(safety.admit({{}, {0, 0.9, 0}, 0}, true, kDt).action, Safety::Action::Step);
}

TEST(Safety, ExactlyTheLargestSpeedIsNotTooFast) {
  constexpr double kPeriod = 1.0 / 1024;  // so that position and speed are exact
  Safety safety({0, 100, 2, 0.02, kPeriod});
  const auto status_at = [&](double x, double speed) {
    return safety.admit({{x, 0, 0}, {speed, 0, 0}, 0}, true, kPeriod).status;
  };
  for (int i = 0; i < 4; ++i) EXPECT_EQ(status_at(2 * kPeriod * i, 2), 0U);
  EXPECT_EQ(status_at(8.01 * kPeriod, 0), PALPATE_LOOP_TOO_FAST);
}

/// A sample that is no position has no speed, and the first one no earlier one to be far from.
TEST(Safety, ALoopBeginsWithoutACutOffWhereverItsDeviceIs) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vec3& first : {Vec3{nan, 0, 0}, Vec3{30, -20, 10}}) {
    Safety safety({0, 100, 0.5, 0.02, kDt});
    EXPECT_EQ(safety.admit({first, kStill, 0}, true, kDt).status & PALPATE_LOOP_TOO_FAST, 0U);
  }
}

TEST(Safety, AGapCutsOff) {
  Safety safety = ready({0.1, 100, 2, 0.02});
  EXPECT_EQ(safety.admit({}, true, 0.021).action, Safety::Action::Suspend);
  EXPECT_EQ(safety.limit({1, 0, 0}, 0).force, Vec3{});
  EXPECT_EQ(safety.admit({}, true, kDt).action, Safety::Action::Step);
  EXPECT_EQ(judge(safety, {1, 0, 0}, kStill, 0.021).status, PALPATE_LOOP_LATE);
}

TEST(Safety, WithoutANewSampleTheForceFallsToZeroAndThenTheDeviceIsLost) {
  constexpr double kLimit = 0.0205;  // s, twenty periods and a half
  Safety safety = ready({0.1, 100, 2, kLimit});
  for (int i = 1; i <= 1025; ++i) {
    const auto admission = safety.admit({}, false, kDt);
    ASSERT_EQ(admission.action, Safety::Action::Step) << i;
    EXPECT_EQ((admission.status & PALPATE_LOOP_OUTDATED) != 0, i > 20) << i;
    const double fade = i <= 20 ? 1 : std::max(0.0, 2 - i * kDt / kLimit);
    EXPECT_NEAR(safety.limit({1, 0, 0}, 1e-3).force[0], fade, 1e-9) << i;
  }
  EXPECT_EQ(safety.admit({}, false, kDt).action, Safety::Action::Lost);
}

TEST(Safety, TheFirstSampleAfterSilenceCutsOff) {
  Safety safety = ready({0.1, 100, 2, 0.02});
  for (int i = 0; i < 15; ++i) safety.admit({}, false, kDt);
  EXPECT_EQ(safety.admit({}, true, kDt).action, Safety::Action::Step);
  for (int i = 0; i < 25; ++i) safety.admit({}, false, kDt);
  EXPECT_EQ(safety.admit({}, true, kDt).action, Safety::Action::Suspend);
  EXPECT_EQ(safety.admit({}, true, kDt).action, Safety::Action::Step);
}

TEST(Safety, AStallIsNoSilence) {
  // The machine slept for an hour: the device is not lost, whatever its first read says.
  Safety safety = ready({0.1, 100, 2, 0.02});
  EXPECT_EQ(safety.admit({}, false, 3600).action, Safety::Action::Suspend);
  EXPECT_NE(safety.admit({}, true, kDt).action, Safety::Action::Lost);
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
