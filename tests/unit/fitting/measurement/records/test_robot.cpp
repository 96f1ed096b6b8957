// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fitting/measurement/records/repeats.hpp"
#include "fitting/measurement/records/robot.hpp"
#include "format/error.hpp"
#include "tests/unit/fitting/measurement/records/bench.hpp"

namespace palpate::measured {
namespace {

using testing::HasSubstr;

const Vec3 kInward{0, 0, -1};
const Bench kBench;
constexpr double kLateralStiffness = 55;  // N/m
constexpr double kSlipAt = 0.0022;        // m

/// A flat fan: vertex 0 in the middle of a hexagon of 12 mm, all in the plane z = 0.
Body plate() {
  Body body;
  body.name = "plate";
  body.nodes.push_back({0, 0, 0});
  for (int i = 0; i < 6; ++i) {
    const double angle = i * std::numbers::pi / 3;
    body.nodes.push_back({0.012 * std::cos(angle), 0.012 * std::sin(angle), 0});
  }
  for (std::int32_t v = 0; v < 7; ++v) {
    body.response.node.push_back(v);
    body.response.inward.push_back(kInward);
    body.response.is_site.push_back(1);
  }
  return body;
}

struct Drag {
  double depth = 0.004, travel = 0.003;
  Vec3 direction{0.6, 0.8, 0};
  Vec3 touch{0.0006, -0.0004, 0};
  Vec3 sensor_offset{0.03, -0.05, 0.2};
  double noise = 0.001;
  bool drags = true;
  double stiffness = kLateralStiffness;
};

/// Approach over 2 mm, press to a depth, drag sideways: force stuck up to the slip, then constant.
RobotLog log_of(const Drag& drag, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> noise(0, drag.noise);
  RobotLog log;
  log.name = "log";
  const double down = (0.002 + drag.depth) / kBench.speed, side = drag.travel / kBench.speed;
  for (int i = 0; i < static_cast<int>((down + (drag.drags ? side : 1)) * 50); ++i) {
    const double t = i / 50.0;
    const double depth = std::min(t, down) * kBench.speed - 0.002;
    const double s = drag.drags ? std::max(0.0, t - down) * kBench.speed : 0;
    const Vec3 jitter{noise(engine), noise(engine), noise(engine)};
    log.time.push_back(t);
    log.tip.push_back(drag.touch + depth * kInward + s * drag.direction);
    log.force.push_back(sneddon_force(depth, kBench.radius, kBench.modulus) * kInward +
                        drag.stiffness * std::min(s, kSlipAt) * drag.direction +
                        drag.sensor_offset + jitter);
  }
  return log;
}

TEST(Robot, PressAndDragAreToldApart) {
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
  const double held = sneddon_force(drag.depth, kBench.radius, kBench.modulus);
  for (const CurveSample& s : lateral.samples) {
    EXPECT_NEAR(dot(s.force, lateral.direction),
                kLateralStiffness * std::min(s.displacement, kSlipAt), 0.006);
    EXPECT_NEAR(dot(s.force, kInward), held, 0.02 * held);
  }
}

/// A lateral path is stuck: what comes after the slip is no part of it.
TEST(Robot, ThePathEndsWhereTheToolSlips) {
  RobotSettings settings;
  settings.lateral_samples = 24;
  const RobotCurves curves = analyse_robot_log(log_of({}, 2), plate(), settings);
  ASSERT_TRUE(curves.drag);
  EXPECT_NEAR(curves.drag->slip, kSlipAt, 0.0003);
  EXPECT_LE(curves.drag->travel.back(), kSlipAt + 0.0003);
  Drag shorter;
  shorter.travel = 0.0015;
  const RobotCurves stuck = analyse_robot_log(log_of(shorter, 3), plate(), settings);
  ASSERT_TRUE(stuck.drag);
  EXPECT_TRUE(std::isnan(stuck.drag->slip));
  EXPECT_NEAR(stuck.drag->travel.back(), 0.0015, 0.0001);
}

TEST(Robot, APressAloneHasNoLateralPath) {
  Drag press;
  press.drags = false;
  EXPECT_FALSE(analyse_robot_log(log_of(press, 4), plate(), {}).drag);
}

DragCurve drag_of(const Drag& drag, unsigned seed) {
  return *analyse_robot_log(log_of(drag, seed), plate(), {}).drag;
}

/// Repeats of a drag that differ by a known scatter of the stiffness: the path is their mean, and
/// its uncertainty that of a mean.
TEST(Drags, RepeatsAreAveragedWithTheirScatter) {
  constexpr int kRepeats = 20;
  std::mt19937 engine(3);
  std::normal_distribution<double> normal(0, 1);
  std::vector<DragCurve> drags;
  double sum = 0, squares = 0;
  for (unsigned i = 0; i < kRepeats; ++i) {
    Drag drag;
    drag.travel = 0.0015;
    drag.stiffness *= 1 + 0.1 * normal(engine);
    sum += drag.stiffness / kRepeats;
    squares += drag.stiffness * drag.stiffness / kRepeats;
    drags.push_back(drag_of(drag, 40 + i));
  }
  const double scatter = std::sqrt((squares - sum * sum) * kRepeats / (kRepeats - 1));
  const auto paths = lateral_paths(drags, kInward, {6}, "site");
  ASSERT_EQ(paths.size(), 1U);
  EXPECT_EQ(paths[0].repeats, kRepeats);
  ASSERT_EQ(paths[0].samples.size(), 7U);
  const CurveSample& end = paths[0].samples.back();
  EXPECT_NEAR(end.displacement, 0.0015, 0.00005);
  EXPECT_NEAR(dot(end.force, paths[0].direction), sum * end.displacement, 0.001);
  EXPECT_NEAR(end.force_scatter, scatter * end.displacement, 0.15 * scatter * end.displacement);
  EXPECT_NEAR(end.force_uncertainty, end.force_scatter / std::sqrt(double{kRepeats}),
              0.02 * end.force_uncertainty);
  // Work of a spring on top of that of the press.
  EXPECT_NEAR(end.tool_work - paths[0].samples.front().tool_work,
              0.5 * sum * end.displacement * end.displacement, 2e-6);
}

TEST(Drags, OtherDepthsAndDirectionsStayApart) {
  Drag deep, shallow, back;
  deep.travel = shallow.travel = back.travel = 0.0015;
  shallow.depth = 0.003;
  back.direction = -1.0 * deep.direction;
  const auto paths =
      lateral_paths({drag_of(deep, 80), drag_of(shallow, 81), drag_of(back, 82), drag_of(deep, 83)},
                    kInward, {6}, "site");
  ASSERT_EQ(paths.size(), 3U);
  EXPECT_EQ(paths[0].repeats, 2);
  EXPECT_EQ(paths[1].repeats, 1);
  EXPECT_NEAR(paths[1].lateral_depth, 0.003, 0.0001);
  EXPECT_LT(dot(paths[2].direction, paths[0].direction), -0.99);
}

/// What is stated of single drags covers the truth: noise and depth of a stuck contact whose
/// stiffness goes as the root of the depth.
TEST(Drags, UncertaintyCoversTheTruth) {
  int inside = 0, total = 0;
  for (unsigned trial = 0; trial < 100; ++trial) {
    Drag drag;
    drag.travel = 0.0015;
    drag.noise = 0.002;
    const CurvePath path = lateral_paths({drag_of(drag, 100 + trial)}, kInward, {6}, "s").front();
    for (std::size_t i = 2; i < path.samples.size(); i += 2) {
      const CurveSample& s = path.samples[i];
      const double truth = drag.stiffness * s.displacement;
      if (std::abs(dot(s.force, path.direction) - truth) <= 2 * s.force_uncertainty) ++inside;
      ++total;
    }
  }
  RecordProperty("inside_percent", 100 * inside / total);
  EXPECT_GE(inside, 0.88 * total);
}

/// The force sensor's calibration is common to all repeats and does not average out.
TEST(Drags, CalibrationDoesNotAverageOut) {
  std::vector<DragCurve> drags;
  Drag drag;
  drag.travel = 0.0015;
  for (unsigned i = 0; i < 10; ++i) drags.push_back(drag_of(drag, 300 + i));
  const CurveSample end = lateral_paths(drags, kInward, {6, 0.05}, "s").front().samples.back();
  EXPECT_GE(end.force_uncertainty, 0.05 * drag.stiffness * end.displacement * 0.98);
  EXPECT_LT(end.force_uncertainty, 0.06 * drag.stiffness * end.displacement);
}

/// The frame of the robot is any: fiducials bring it to the body, forces turn with it.
TEST(Robot, FiducialsPlaceTheLogOnTheBody) {
  const double a = 0.7, b = -1.1;
  const auto to_robot = [&](const Vec3& v) {
    const Vec3 w{std::cos(a) * v[0] - std::sin(a) * v[1], std::sin(a) * v[0] + std::cos(a) * v[1],
                 v[2]};
    return Vec3{w[0], std::cos(b) * w[1] - std::sin(b) * w[2],
                std::sin(b) * w[1] + std::cos(b) * w[2]};
  };
  const Vec3 origin{0.4, -0.3, 0.25};
  std::vector<Fiducial> fiducials;
  for (const Vec3& x :
       {Vec3{0.05, 0, 0}, Vec3{-0.05, 0.01, 0}, Vec3{0, 0.06, 0.01}, Vec3{0.02, -0.05, -0.02}}) {
    fiducials.push_back({to_robot(x) + origin, x});
  }
  const Registration registration = register_fiducials(fiducials, "sidecar");
  EXPECT_LT(registration.rms, 1e-12);
  const RobotLog plain = log_of({}, 5);
  RobotLog log = plain;
  for (std::size_t i = 0; i < log.tip.size(); ++i) {
    log.tip[i] = registration.motion(to_robot(log.tip[i]) + origin);
    log.force[i] = registration.motion.rotate(to_robot(log.force[i]));
    EXPECT_NEAR(norm(log.tip[i] - plain.tip[i]), 0, 1e-12);
    EXPECT_NEAR(norm(log.force[i] - plain.force[i]), 0, 1e-12);
  }
  fiducials[0].body[0] += 0.002;
  const Registration off = register_fiducials(fiducials, "sidecar");
  EXPECT_GT(off.rms, 0.0002);
  EXPECT_LT(off.rms, 0.002);
}

TEST(Robot, AMirroredSetOfFiducialsIsNotTurnedIntoAMirror) {
  std::vector<Fiducial> fiducials;
  for (const Vec3& x :
       {Vec3{0.05, 0, 0.01}, Vec3{-0.05, 0.01, 0}, Vec3{0, 0.06, -0.02}, Vec3{0.02, -0.05, 0.03}}) {
    fiducials.push_back({{-x[0], x[1], x[2]}, x});
  }
  const RigidMotion motion = register_fiducials(fiducials, "s").motion;
  EXPECT_NEAR(dot(cross(motion.rows[0], motion.rows[1]), motion.rows[2]), 1, 1e-12);
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
  EXPECT_THAT(refusal(slanted), HasSubstr("degrees off the inward direction"));
  EXPECT_EQ(refusal(log_of({}, 10)), "accepted");
  RobotLog pulling = log_of({}, 11);
  for (Vec3& f : pulling.force) f = -1.0 * f;
  EXPECT_THAT(refusal(pulling), HasSubstr("pulls the body outwards; check placement.force_is"));
  const std::vector<Fiducial> line{
      {{0, 0, 0}, {0, 0, 0}}, {{1, 0, 0}, {1, 0, 0}}, {{2, 0, 0}, {2, 0, 0}}};
  EXPECT_THROW(register_fiducials(line, "s"), Error);
  EXPECT_THROW(register_fiducials({}, "s"), Error);
}

}  // namespace
}  // namespace palpate::measured
