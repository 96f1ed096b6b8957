// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/run/force_clamp.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace palpate::app {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

fitting::DeviceProfile profile_with(double continuous, double peak) {
  fitting::DeviceProfile profile;
  profile.continuous_force = continuous;
  profile.peak_force = peak;
  return profile;
}

TEST(ForceClamp, IsByDefaultWhatTheDeviceSustains) {
  const ForceClamp clamp = force_clamp(profile_with(0.9, 3.3), {}, kNone);
  EXPECT_EQ(clamp.max_force, 0.9);
  EXPECT_NE(clamp.origin.find("continuous"), std::string::npos);
}

TEST(ForceClamp, IsThePeakForceWhereNothingElseIsKnown) {
  EXPECT_EQ(force_clamp(profile_with(kNone, 3.3), {}, kNone).max_force, 3.3);
  EXPECT_EQ(force_clamp(profile_with(kNone, kNone), {}, 7.9).max_force, 7.9);
  const ForceClamp none = force_clamp(profile_with(kNone, kNone), {}, kNone);
  EXPECT_TRUE(std::isinf(none.max_force));
  EXPECT_TRUE(none.origin.empty());
}

TEST(ForceClamp, TheUserMayAskForMoreThanTheContinuousForceButNotThanThePeak) {
  EXPECT_EQ(force_clamp(profile_with(0.9, 3.3), 2.0, kNone).max_force, 2.0);
  EXPECT_EQ(force_clamp(profile_with(0.9, 3.3), 0.5, kNone).max_force, 0.5);
  EXPECT_EQ(force_clamp(profile_with(0.9, 3.3), 20.0, kNone).max_force, 3.3);
  EXPECT_EQ(force_clamp(profile_with(0.9, kNone), 20.0, 2.5).max_force, 2.5);
}

TEST(ForceClamp, ADriverThatStatesNoForceStatesNothing) {
  EXPECT_EQ(force_clamp(profile_with(0.9, 3.3), {}, 0).max_force, 0.9);
}

}  // namespace
}  // namespace palpate::app
