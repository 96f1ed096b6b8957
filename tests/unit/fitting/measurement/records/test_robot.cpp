// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fitting/measurement/records/repeats.hpp"
#include "fitting/measurement/records/robot.hpp"
#include "format/error.hpp"
#include "tests/unit/fitting/measurement/records/robot_log.hpp"

namespace palpate::measured {
namespace {

using testing::HasSubstr;

TEST(Robot, SeparatesPressAndDrag) {
  const Drag drag;
  RobotSettings settings;
  settings.lateral_samples = 24;
  const RobotCurves curves = analyse_robot_log(log_of(drag, 1), plate(), settings);
  EXPECT_EQ(curves.site.vertex, 0);
  EXPECT_NEAR(norm(curves.touch - drag.touch), 0, 60e-6);
  EXPECT_LT(curves.tilt, 0.05);
  const CurvePath path = mean_path({curves.press}, kInward, {}, "log");
  for (const CurveSample& s : path.samples) {
    EXPECT_NEAR(dot(s.force, kInward), sneddon_force(s.displacement, kBench.radius, kBench.modulus),
                4 * s.force_uncertainty + 1e-3);
  }
  ASSERT_TRUE(curves.drag);
  const CurvePath lateral = lateral_paths({*curves.drag}, kInward, {24}, "log").front();
  EXPECT_EQ(lateral.kind, PathKind::Lateral);
  EXPECT_EQ(lateral.repeats, 1);
  EXPECT_NEAR(lateral.lateral_depth, drag.depth, 0.02 * drag.depth);
  EXPECT_NEAR(dot(lateral.direction, drag.direction), 1, 1e-3);
  EXPECT_NEAR(dot(lateral.direction, kInward), 0, 1e-12);
  EXPECT_EQ(lateral.samples.front().displacement, 0);
  const double normal = sneddon_force(drag.depth, kBench.radius, kBench.modulus);
  for (const CurveSample& s : lateral.samples) {
    EXPECT_NEAR(dot(s.force, lateral.direction),
                kLateralStiffness * std::min(s.displacement, kSlipAt), 0.006);
    EXPECT_NEAR(dot(s.force, kInward), normal, 0.02 * normal);
  }
}

/// A lateral path ends at the slip.
TEST(Robot, ThePathEndsWhereTheToolSlips) {
  RobotSettings settings;
  settings.lateral_samples = 24;
  const RobotCurves curves = analyse_robot_log(log_of({}, 2), plate(), settings);
  ASSERT_TRUE(curves.drag);
  EXPECT_NEAR(curves.drag->slip, kSlipAt, 0.0003);
  EXPECT_LE(curves.drag->travel.back(), kSlipAt + 0.0003);
  Drag shorter;
  shorter.travel = 0.0015;
  const RobotCurves no_slip = analyse_robot_log(log_of(shorter, 3), plate(), settings);
  ASSERT_TRUE(no_slip.drag);
  EXPECT_TRUE(std::isnan(no_slip.drag->slip));
  EXPECT_NEAR(no_slip.drag->travel.back(), 0.0015, 0.0001);
}

TEST(Robot, APressAloneHasNoLateralPath) {
  Drag press;
  press.drags = false;
  EXPECT_FALSE(analyse_robot_log(log_of(press, 4), plate(), {}).drag);
}

/// A sphere whose centre is logged touches at its radius below it.
TEST(Robot, CentreOfTheToolIsBroughtToItsTip) {
  RobotLog log = log_of({}, 6);
  for (Vec3& x : log.tip) x = x - kBench.radius * kInward;
  RobotSettings settings;
  settings.centre_to_tip = kBench.radius;
  const RobotCurves curves = analyse_robot_log(log, plate(), settings);
  EXPECT_EQ(curves.site.vertex, 0);
  EXPECT_NEAR(norm(curves.touch - Drag{}.touch), 0, 60e-6);
}

TEST(Robot, RefusesWhatIsNotOnTheBody) {
  const auto refusal = [](const RobotLog& log) -> std::string {
    try {
      analyse_robot_log(log, plate(), {});
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  RobotLog far = log_of({}, 7);
  for (Vec3& x : far.tip) x[1] += 0.05;
  EXPECT_THAT(refusal(far), HasSubstr("mm away; check the frame"));
  RobotLog up = log_of({}, 8);
  for (Vec3& x : up.tip) x[2] = -x[2];
  EXPECT_THAT(refusal(up), HasSubstr("does not go into the body"));
  RobotLog slanted = log_of({}, 9);
  for (Vec3& x : slanted.tip) x[0] -= 0.9 * x[2];
  EXPECT_THAT(refusal(slanted), HasSubstr("degrees off the press direction"));
  EXPECT_EQ(refusal(log_of({}, 10)), "accepted");
  RobotLog pulling = log_of({}, 11);
  for (Vec3& f : pulling.force) f = -1.0 * f;
  EXPECT_THAT(
      refusal(pulling),
      HasSubstr(
          "the force points out of the body where the tool is deepest; check placement.force_is"));
  const std::vector<Fiducial> line{
      {{0, 0, 0}, {0, 0, 0}}, {{1, 0, 0}, {1, 0, 0}}, {{2, 0, 0}, {2, 0, 0}}};
  EXPECT_THROW(register_fiducials(line, "s"), Error);
  EXPECT_THROW(register_fiducials({}, "s"), Error);
}

}  // namespace
}  // namespace palpate::measured
