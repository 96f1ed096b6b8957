// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/identify/device_findings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "app/pipeline/device_profile.hpp"
#include "fitting/measurement/identify/directions.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

/// B = diag(3, 1, 2) turned by 30 degrees about z: its smallest eigenvalue is 1, below every entry
/// of the diagonal. Dry friction and delay differ from direction to direction.
std::vector<DirectionFinding> turned() {
  const double c = std::cos(0.5236), s = std::sin(0.5236);
  std::vector<DirectionFinding> found;
  for (const Vec3& n : identify::directions_between({0, 1, 2})) {
    const double a = c * n[0] + s * n[1], b = c * n[1] - s * n[0];
    DirectionFinding f{n, {}, 1e-5, 0};
    f.estimate.damping[0] = {3 * a * a + b * b + 2 * n[2] * n[2], 0.01};
    f.estimate.friction = {0.05, 0.001};
    f.estimate.delay = {1.2e-3, 1e-5};
    f.estimate.spread = {{1.3e-3, 2e-5}, 40, 1e-5, 2e-5};
    found.push_back(f);
  }
  found[4].position_step = 3e-5;
  found[7].estimate.friction = {0.03, 0.002};  // of a diagonal
  found[9].estimate.spread.latest = {1.5e-3, 4e-5};
  return found;
}

TEST(DeviceFindings, AreThoseOfTheWorstDirection) {
  const DeviceFindings found = combine(turned());
  EXPECT_TRUE(found.missing.empty());
  EXPECT_NEAR(found.damping, 1, 1e-9);
  EXPECT_LT(found.profile.damping, 0.99);
  EXPECT_GT(found.profile.damping, 0.9);
  EXPECT_NEAR(found.profile.coulomb_friction, 0.03 - 2.5 * 0.002, 1e-12);
  // Whole: a fixed latency does not shrink with the period of a faster loop.
  EXPECT_NEAR(found.profile.delay, 1.5e-3 + 2.5 * 4e-5 + 1e-5 + 0.75 * 2e-5, 1e-12);
  EXPECT_EQ(found.profile.position_resolution, 3e-5);
  EXPECT_TRUE(std::isnan(found.profile.force_resolution));
}

/// A busy computer: its periods are longer than the nominal one.
TEST(DeviceFindings, CountThePeriodsOfTheLoop) {
  std::vector<DirectionFinding> busy = turned();
  busy[9].longer = 4e-4;
  EXPECT_NEAR(combine(busy).profile.delay, combine(turned()).profile.delay + 3e-4, 1e-12);
}

TEST(DeviceFindings, LackWhatIsNotCertain) {
  std::vector<DirectionFinding> directions = turned();
  for (DirectionFinding& d : directions) d.estimate.damping[0].deviation = 0.6;
  directions[1].estimate.friction = {0.001, 0.01};
  const DeviceFindings uncertain = combine(directions);
  ASSERT_EQ(uncertain.missing.size(), 1U);
  EXPECT_EQ(uncertain.missing[0].constant, "damping");
  EXPECT_TRUE(std::isnan(uncertain.profile.damping));
  EXPECT_EQ(uncertain.profile.coulomb_friction, 0);  // a true bound, if a weak one

  directions = turned();
  directions[0].estimate.problem = "it does not move";
  const DeviceFindings blocked = combine(directions);
  EXPECT_EQ(blocked.missing.size(), 3U);
  EXPECT_EQ(blocked.missing[0].reason,
            "along " + identify::direction_name(directions[0].direction) + " it does not move");
  EXPECT_TRUE(std::isnan(blocked.profile.damping));
  EXPECT_TRUE(std::isnan(blocked.profile.delay));

  directions = turned();
  directions[2].estimate.spread = {};
  const DeviceFindings undated = combine(directions);
  ASSERT_EQ(undated.missing.size(), 1U);
  EXPECT_EQ(undated.missing[0].constant, "delay");
  EXPECT_TRUE(std::isnan(undated.profile.delay));
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
