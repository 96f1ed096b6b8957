// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/simulate/hand_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace palpate::app {
namespace {

constexpr double kClearance = 0.003;  // m, of the start above the surface: the depth of the press

/// A straight path along x on the plane z = 0.
std::vector<PathPoint> straight(double length) {
  std::vector<PathPoint> path;
  for (int i = 0; i <= 60; ++i) {
    const double at = length * i / 60;
    path.push_back({at, {at, 0, 0}, {0, 0, -1}});
  }
  return path;
}

SimulateSection script() {
  SimulateSection script;
  script.press_depth = 0.003;
  script.press_speed = 0.01;
  script.hold = 0;
  script.slide_length = 0.03;
  script.slide_speed = 0.03;
  return script;
}

TEST(HandPath, PressesSlidesAndReleases) {
  const HandPath hand(script(), straight(0.03));
  double deepest = 0, fastest = 0, fastest_press = 0;
  for (double t = 0; t < hand.duration(); t += 1e-3) {
    const HandState state = hand.at(t);
    deepest = std::max(deepest, -state.position[2]);
    fastest = std::max(fastest, std::abs(state.velocity[0]));
    fastest_press = std::max(fastest_press, std::abs(state.velocity[2]));
    // It slides at the depth of the press only.
    if (std::abs(state.velocity[0]) > 1e-6) {
      EXPECT_NEAR(state.position[2], -0.003, 1e-9);
    }
  }
  EXPECT_NEAR(deepest, 0.003, 1e-9);
  EXPECT_NEAR(fastest, 0.03, 1e-4);
  EXPECT_NEAR(fastest_press, 0.01, 1e-4);
  EXPECT_NEAR(hand.at(0).position[2], kClearance, 1e-12);
  EXPECT_NEAR(hand.at(hand.duration()).position[2], kClearance, 1e-12);
  EXPECT_NEAR(hand.at(hand.duration()).position[0], 0.03, 1e-12);
}

/// Press and slide have no jump of the velocity: each part starts and ends at rest.
TEST(HandPath, RestsBetweenItsParts) {
  const HandPath hand(script(), straight(0.03));
  // Of a part whose speed rises and falls as a parabola, the peak is 1.5 times the mean.
  const double press = 1.5 * (kClearance + 0.003) / 0.01, slide = 1.5 * 0.03 / 0.03;
  EXPECT_NEAR(hand.duration(), 2 * press + slide, 1e-12);
  for (const double t : {0.0, press, press + slide, hand.duration()})
    EXPECT_LT(norm(hand.at(t).velocity), 1e-6) << t;
}

TEST(HandPath, HoldsBetweenPressAndSlide) {
  SimulateSection holding = script();
  holding.hold = 0.7;
  const HandPath hand(holding, straight(0.03)), hasty(script(), straight(0.03));
  EXPECT_NEAR(hand.duration(), hasty.duration() + 0.7, 1e-12);
  const double press = 1.5 * (kClearance + 0.003) / 0.01;
  for (const double t : {0.0, 0.3, 0.7}) {
    EXPECT_NEAR(norm(hand.at(press + t).position - Vec3{0, 0, -0.003}), 0, 1e-12) << t;
  }
  for (const double t : {0.1, 1.0, 2.0})
    EXPECT_NEAR(norm(hand.at(press + 0.7 + t).position - hasty.at(press + t).position), 0, 1e-12);
}

TEST(HandPath, WithoutASlideOnlyPresses) {
  const HandPath hand(script(), {{0, {0, 0, 0}, {0, 0, -1}}});
  EXPECT_NEAR(hand.at(hand.duration() / 2).position[2], -0.003, 1e-12);
  for (double t = 0; t < hand.duration(); t += 0.01) EXPECT_EQ(hand.at(t).position[0], 0);
}

}  // namespace
}  // namespace palpate::app
