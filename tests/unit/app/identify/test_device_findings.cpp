// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/identify/device_findings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "app/pipeline/device_profile.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

AxisFinding finding(std::size_t axis, std::array<double, 3> damping, double deviation,
                    identify::Measured friction, identify::Measured delay, double step) {
  AxisFinding found{axis, {}, step};
  for (std::size_t j = 0; j < 3; ++j) found.estimate.damping[j] = {damping[j], deviation};
  found.estimate.friction = friction;
  found.estimate.delay = delay;
  return found;
}

/// B = diag(3, 1, 2) turned by 30 degrees about z: its smallest eigenvalue is 1, below every entry
/// of the diagonal.
std::vector<AxisFinding> turned() {
  const double c = std::cos(0.5236), s = std::sin(0.5236);
  const double xx = 3 * c * c + s * s, yy = 3 * s * s + c * c, xy = 2 * c * s;
  return {finding(0, {xx, xy, 0}, 0.01, {0.05, 0.001}, {1.2e-3, 1e-5}, 1e-5),
          finding(1, {xy, yy, 0}, 0.02, {0.03, 0.002}, {1.5e-3, 2e-5}, 3e-5),
          finding(2, {0, 0, 2}, 0.01, {0.04, 0.001}, {1.1e-3, 1e-5}, 2e-5)};
}

TEST(DeviceFindings, AreThoseOfTheWorstDirection) {
  const DeviceFindings found = combine(turned());
  EXPECT_TRUE(found.missing.empty());
  EXPECT_NEAR(found.damping, 1, 1e-9);
  EXPECT_NEAR(found.profile.damping, 1 - 2.5 * std::sqrt(3 * (1e-4 + 4e-4 + 1e-4)), 1e-9);
  EXPECT_NEAR(found.profile.coulomb_friction, 0.03 - 2.5 * 0.002, 1e-12);
  // Whole: a fixed latency does not shrink with the period of a faster loop.
  EXPECT_NEAR(found.profile.delay, 1.5e-3 + 2.5 * 2e-5, 1e-12);
  EXPECT_EQ(found.profile.position_resolution, 3e-5);
  EXPECT_TRUE(std::isnan(found.profile.force_resolution));
}

TEST(DeviceFindings, LackWhatIsNotCertain) {
  std::vector<AxisFinding> axes = turned();
  axes[0].estimate.damping[0].deviation = 0.6;
  axes[1].estimate.friction = {0.001, 0.01};
  const DeviceFindings uncertain = combine(axes);
  ASSERT_EQ(uncertain.missing.size(), 1U);
  EXPECT_EQ(uncertain.missing[0].constant, "damping");
  EXPECT_TRUE(std::isnan(uncertain.profile.damping));
  EXPECT_EQ(uncertain.profile.coulomb_friction, 0);  // a true bound, if a weak one

  axes = turned();
  axes[2].estimate.problem = "it does not move";
  const DeviceFindings blocked = combine(axes);
  EXPECT_EQ(blocked.missing.size(), 3U);
  EXPECT_EQ(blocked.missing[0].reason, "along z it does not move");
  EXPECT_TRUE(std::isnan(blocked.profile.damping));
  EXPECT_TRUE(std::isnan(blocked.profile.delay));
}

TEST(DeviceFindings, BecomeAProfileThatIsReadAsItIs) {
  DeviceFindings found = combine(turned());
  found.profile.name = "a \"device\"";
  found.profile.source = "a test";
  found.profile.force_resolution = 0.002;
  found.profile.damping = 0.97999;
  found.profile.delay = 5.40001e-4;
  const samples::TemporaryFolder folder;
  std::ofstream(folder / "p.toml") << profile_text(found, turned());
  const fitting::DeviceProfile read = read_device_profile(folder / "p.toml");
  EXPECT_EQ(read.name, found.profile.name);
  EXPECT_NEAR(read.damping, found.profile.damping, 1e-3 * read.damping);
  EXPECT_LE(read.damping, found.profile.damping);  // rounded to the safe side
  EXPECT_NEAR(read.delay, found.profile.delay, 1e-3 * read.delay);
  EXPECT_GE(read.delay, found.profile.delay);
  EXPECT_NEAR(read.position_resolution, 3e-5, 1e-9);
  EXPECT_EQ(read.force_resolution, 0.002);
  EXPECT_TRUE(std::isnan(read.peak_force));
}

}  // namespace
}  // namespace palpate::app
