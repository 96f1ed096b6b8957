// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/identify/directions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "fitting/measurement/identify/estimate.hpp"
#include "tests/unit/fitting/measurement/identify/moved_device.hpp"

namespace palpate::identify {
namespace {

using samples::MovedDevice;

std::vector<Directional> values(const std::vector<Vec3>& directions, double (*value)(const Vec3&),
                                double deviation = 0) {
  std::vector<Directional> found;
  for (const Vec3& n : directions) found.push_back({n, {value(n), deviation}});
  return found;
}

TEST(Directions, AreTheAxesAndTheDiagonalsBetweenThem) {
  EXPECT_EQ(directions_between({1}).size(), 1U);
  EXPECT_EQ(directions_between({0, 2}).size(), 4U);
  const std::vector<Vec3> all = directions_between({0, 1, 2});
  EXPECT_EQ(all.size(), 13U);
  std::set<std::string> names;
  for (const Vec3& n : all) {
    EXPECT_NEAR(norm(n), 1, 1e-12);
    names.insert(direction_name(n));
    const Frame frame = frame_along(n);
    EXPECT_EQ(frame[0], n);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        EXPECT_NEAR(dot(frame[i], frame[j]), i == j ? 1 : 0, 1e-12) << direction_name(n);
    EXPECT_NEAR(norm(in_frame(frame, {1, 2, 3})), std::sqrt(14.0), 1e-12);
    EXPECT_NEAR(in_frame(frame, {1, 2, 3})[0], dot(n, {1, 2, 3}), 1e-12);
  }
  EXPECT_EQ(names.size(), 13U);
  EXPECT_EQ(names.count("x-y+z"), 1U);
}

/// B = diag(3, 1, 2) turned by 30 degrees about z.
TEST(SmallestDamping, IsThatOfTheWeakestDirection) {
  const auto along = [](const Vec3& n) {
    const double c = std::cos(0.5236), s = std::sin(0.5236);
    const double a = c * n[0] + s * n[1], b = -s * n[0] + c * n[1];
    return 3 * a * a + b * b + 2 * n[2] * n[2];
  };
  EXPECT_NEAR(smallest_damping(values(directions_between({0, 1, 2}), along)).value, 1, 1e-9);
  EXPECT_NEAR(smallest_damping(values(directions_between({0, 1}), along)).value, 1, 1e-9);
  EXPECT_NEAR(smallest_damping(values(directions_between({2}), along)).value, 2, 1e-9);
  const Measured known = smallest_damping(values(directions_between({2}), along, 0.1));
  EXPECT_NEAR(known.deviation, 0.1, 1e-12);
}

/// What a direction shows for certain counts, not its best estimate.
TEST(SmallestFriction, IsThatOfTheDirectionWithTheSmallestLowerBound) {
  const std::vector<Directional> friction{
      {{1, 0, 0}, {0.020, 0.0001}}, {{0, 1, 0}, {0.022, 0.003}}, {{0, 0, 1}, {0.030, 0.001}}};
  EXPECT_EQ(smallest_friction(friction).value, 0.022);
  EXPECT_NEAR(smallest_friction(friction).low(), 0.0145, 1e-12);
}

/// Joints at right angles that lie along diagonals: along each axis two or three of them rub, and
/// damping and friction are smallest between the axes.
TEST(SmallestFriction, OfJointsAlongDiagonalsIsThatOfAJoint) {
  MovedDevice d;
  const double half = std::sqrt(0.5);
  d.joints = {{{half, half, 0}, {-half, half, 0}, {0, 0, 1}}};
  d.damping = {0.15, 0.1, 0.2};
  d.friction = {0.02, 0.02, 0.06};
  d.resolution = 1e-6;
  std::vector<Directional> friction, damping, along_axes;
  for (const Vec3& n : directions_between({0, 1, 2})) {
    const AxisEstimate e = estimate_axis(samples::moved_along(d, n), samples::kLargestDelay);
    ASSERT_EQ(e.problem, "") << direction_name(n);
    friction.push_back({n, e.friction});
    damping.push_back({n, e.damping[0]});
    if (direction_name(n).size() == 1) along_axes.push_back(friction.back());
  }
  EXPECT_GT(smallest_friction(along_axes).low(), 1.3 * 0.02);  // sqrt(2) times that of a joint
  EXPECT_NEAR(smallest_friction(friction).value, 0.02, 0.05 * 0.02);
  EXPECT_LT(smallest_friction(friction).low(), 0.02);
  const Measured smallest = smallest_damping(damping);
  EXPECT_NEAR(smallest.value, 0.1, 0.05 * 0.1);
  EXPECT_LT(smallest.low(), 0.1);
}

/// Three joints alike at right angles, turned at random: how much less a joint rubs than the
/// direction that shows least.
TEST(SmallestFriction, BetweenDirectionsIsAtLeastSevenTenthsOfThatAlongThem) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const std::vector<Vec3> all = directions_between({0, 1, 2});
  double largest = 0, largest_of_axes = 0;
  for (int trial = 0; trial < 50000; ++trial) {
    Vec3 first{normal(random), normal(random), normal(random)};
    first = (1 / norm(first)) * first;
    const Frame frame = frame_along(first);
    const double angle = M_PI * normal(random), c = std::cos(angle), s = std::sin(angle);
    const Frame joints{first, c * frame[1] + s * frame[2], c * frame[2] - s * frame[1]};
    double least = kInfinity, least_of_axes = kInfinity;
    for (const Vec3& n : all) {
      double p = 0;
      for (const Vec3& joint : joints) p += std::abs(dot(joint, n));
      least = std::min(least, p);
      if (direction_name(n).size() == 1) least_of_axes = std::min(least_of_axes, p);
    }
    largest = std::max(largest, least);
    largest_of_axes = std::max(largest_of_axes, least_of_axes);
  }
  EXPECT_LT(0.695 * largest, 1);
  EXPECT_GT(0.72 * largest, 1);
  EXPECT_GT(0.62 * largest_of_axes, 1);  // sqrt(3) where the diagonal of the joints is an axis
}

/// Along no direction does a tip that joints lead astray show more friction than a motion along it
/// meets.
TEST(SmallestFriction, OfJointsThatLeadTheTipAstrayIsOnTheSafeSide) {
  MovedDevice d;
  const Frame askew = frame_along({0.48, 0.6, 0.64});
  d.joints = askew;
  d.mass = {0.1, 0.07, 0.13};
  d.friction = {0.03, 0.02, 0.04};
  for (const Vec3& n : directions_between({0, 1, 2})) {
    const AxisEstimate e = estimate_axis(samples::moved_along(d, n), samples::kLargestDelay);
    double along = 0;
    for (std::size_t j = 0; j < 3; ++j) along += d.friction[j] * std::abs(dot(d.joints[j], n));
    EXPECT_LT(e.friction.low(), along) << direction_name(n);
  }
}

}  // namespace
}  // namespace palpate::identify
