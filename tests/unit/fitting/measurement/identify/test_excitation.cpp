// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/identify/excitation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/unit/fitting/measurement/identify/moved_device.hpp"

namespace palpate::identify {
namespace {

TEST(Excitation, StaysWithinForceAndBoxForLightAndHeavyDevices) {
  for (const double mass : {0.02, 0.1, 0.5}) {
    samples::MovedDevice d;
    d.mass = {mass, mass, mass};
    d.max_force = 0.8;
    const MotionRecord record = samples::moved(d, 1);
    double force = 0, way = 0;
    for (std::size_t i = 0; i < record.time.size(); ++i) {
      for (const double f : record.command[i]) force = std::max(force, std::abs(f));
      way = std::max(way, norm(record.position[i]));
    }
    EXPECT_LE(force, 0.8);
    EXPECT_GT(force, 0.3) << mass;
    EXPECT_LT(way, d.box) << mass;
    EXPECT_GT(way, 0.05 * d.box) << mass;
  }
}

TEST(Excitation, BeginsAndEndsWithoutForce) {
  const samples::MovedDevice d;
  const MotionRecord record = samples::moved(d, 0);
  EXPECT_EQ(norm(record.command.front()), 0);
  // The spring to the start remains, the sines do not.
  EXPECT_LE(norm(record.command.back()), 0.25 * d.max_force);
}

TEST(Excitation, EndsOutsideOfTheBox) {
  Excitation excitation({{1, 0, 0}, 1, 0.02, 10});
  EXPECT_EQ(norm(excitation.command(0, {0.1, 0.2, 0.3})), 0);
  EXPECT_NEAR(excitation.command(1e-3, {0.1, 0.21, 0.3})[1], -0.125,
              1e-12);  // a quarter of 1 N at 20 mm
  EXPECT_EQ(norm(excitation.command(2e-3, {0.1, 0.2, 0.321})), 0);
  EXPECT_TRUE(excitation.left_box());
  EXPECT_EQ(norm(excitation.command(3e-3, {0.1, 0.21, 0.3})), 0);  // for good
  Excitation broken({{1, 0, 0}, 1, 0.02, 10});
  EXPECT_EQ(norm(broken.command(0, {std::numeric_limits<double>::quiet_NaN(), 0, 0})), 0);
  EXPECT_TRUE(broken.left_box());
}

}  // namespace
}  // namespace palpate::identify
