// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/devices/serial_chain.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "format/error.hpp"
#include "tests/unit/runtime/devices/arm.hpp"

namespace palpate::test {
namespace {

using runtime::JointKind;
using runtime::SerialChain;

TEST(SerialChain, FollowsTheTrigonometryOfTheArm) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-2, 2);
  for (int i = 0; i < 200; ++i) {
    const double a = any(random), b = any(random), c = any(random);
    const double reach = 0.2 * std::cos(b) + 0.15 * std::cos(b + c);
    const double height = 0.1 - 0.2 * std::sin(b) - 0.15 * std::sin(b + c);
    const auto pose = arm().at({a, b, c});
    EXPECT_NEAR(norm(pose.tip - Vec3{reach * std::cos(a), reach * std::sin(a), height}), 0, 1e-14);
  }
}

TEST(SerialChain, TheColumnsAreTheDerivativesOfTheTip) {
  SerialChain chain({{JointKind::Revolute, {0, 0, 1}, {0.01, 0.02, 0}},
                     {JointKind::Prismatic, {0.6, 0, 0.8}, {}},
                     {JointKind::Revolute, {0, 0.6, 0.8}, {0.1, 0, 0.1}}},
                    {0.2, 0.1, 0.3});
  const std::array<double, 6> q{0.4, 0.03, -1.1};
  const auto pose = chain.at(q);
  for (std::size_t j = 0; j < 3; ++j) {
    auto more = q;
    auto less = q;
    more[j] += 1e-6;
    less[j] -= 1e-6;
    const Vec3 slope = 5e5 * (chain.at(more).tip - chain.at(less).tip);
    EXPECT_NEAR(norm(slope - pose.column[j]), 0, 1e-9) << j;
  }
}

TEST(SerialChain, RefusesNoJointAndAnAxisThatIsNoUnitVector) {
  EXPECT_THROW(SerialChain({{JointKind::Revolute, {0, 0, 2}, {}}}, {}), Error);
  EXPECT_THROW(SerialChain({}, {}), Error);
}

}  // namespace
}  // namespace palpate::test
