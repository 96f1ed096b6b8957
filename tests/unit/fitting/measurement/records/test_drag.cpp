// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fitting/measurement/records/drag.hpp"
#include "tests/unit/fitting/measurement/records/robot_log.hpp"

namespace palpate::measured {
namespace {

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

/// The uncertainty of single drags covers the truth: noise and depth of a contact without slip
/// whose stiffness goes as the root of the depth.
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

}  // namespace
}  // namespace palpate::measured
