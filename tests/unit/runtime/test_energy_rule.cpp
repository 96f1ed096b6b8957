// SPDX-License-Identifier: AGPL-3.0-or-later
// The rule that keeps a slide from creating energy, one decision at a time: never above the budget,
// equal to it when the offset had to be raised, and the offset given back when it may.
#include "runtime/energy_rule.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/bodies.hpp"

namespace palpate::test {
namespace {

using runtime::EnergyTank;
using runtime::EnergyVerdict;
using runtime::judge;
using runtime::least_offset;
using runtime::LocalModel;
using runtime::Surface;

NodeResponse varied(const Vec3& x) {
  NodeResponse r;
  r.status = ResponseStatus::Fitted;
  r.normal = stiffening_curve(0, 500 * (1 + 0.5 * std::sin(100 * x[0])), 7, 0.001);
  r.lateral = stiffening_curve(100, 250, 4, 0.001);
  return r;
}

class EnergyRuleTest : public ::testing::Test {
 protected:
  static double energy(LocalModel model, const Vec3& x, double offset) {
    model.set_offset(offset);
    return model.energy(model.deflection(x));
  }
  double random(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  LocalModel random_model(double offset) {
    const double a = random(0, 1);
    const double b = random(0, 1 - a);
    const auto m = static_cast<std::int32_t>(engine_() % 128);
    return {surface_, {m, {a, b, 1 - a - b}}, offset};
  }
  /// The plate faces +z: depth is along -z.
  static Vec3 tip(const LocalModel& model, double depth, double lateral) {
    return model.contact_point() + Vec3{lateral, 0, -depth};
  }

  Surface surface_{plate(8, 0.08, varied)};
  std::mt19937 engine_{3};
};

TEST_F(EnergyRuleTest, LeastOffsetMeetsTheBudgetFromBelow) {
  for (int trial = 0; trial < 20000; ++trial) {
    const LocalModel model = random_model(0);
    const double depth = random(0.0001, 0.012);
    const Vec3 x = tip(model, depth, random(0, 0.002));
    const double rest = energy(model, x, depth);  // what the lateral part alone holds
    const double budget = rest + (energy(model, x, 0) - rest) * std::pow(10, random(-6, 0.2));
    const double offset = least_offset(model, x, budget, 0, depth);
    ASSERT_LE(energy(model, x, offset), budget);
    if (energy(model, x, 0) <= budget) {
      EXPECT_EQ(offset, 0);
      continue;
    }
    // By bisection: a hair less offset would be over budget.
    double low = 0;
    double high = depth;
    for (int i = 0; i < 100; ++i) {
      const double middle = (low + high) / 2;
      (energy(model, x, middle) <= budget ? high : low) = middle;
    }
    EXPECT_NEAR(offset, high, 1e-6 * depth);
    EXPECT_GE(offset, high - 1e-15);
  }
}

TEST_F(EnergyRuleTest, AnExcessRaisesTheOffset) {
  const LocalModel moved = random_model(0.0002);
  const Vec3 x = tip(moved, 0.004, 0);
  const double budget = 0.5 * energy(moved, x, 0.0002);
  const EnergyVerdict verdict =
      judge(moved, x, moved.respond(moved.deflection(x)), budget, 0.0002, 1e-4);
  EXPECT_TRUE(verdict.limited);
  EXPECT_FALSE(verdict.fix_contact_point);
  EXPECT_GT(verdict.offset, 0.0002);
  EXPECT_NEAR(energy(moved, x, verdict.offset), budget, 1e-8 * budget);
}

TEST_F(EnergyRuleTest, WhatNoOffsetCanLowerHoldsTheContactPoint) {
  const LocalModel moved = random_model(0.0002);
  const Vec3 x = tip(moved, 0.004, 0.003);
  const double lateral_alone = energy(moved, x, 0.004);
  ASSERT_GT(lateral_alone, 0);
  EXPECT_TRUE(judge(moved, x, moved.respond(moved.deflection(x)), 0.9 * lateral_alone, 0, 1e-4)
                  .fix_contact_point);
  EXPECT_FALSE(judge(moved, x, moved.respond(moved.deflection(x)), 1.1 * lateral_alone, 0, 1e-4)
                   .fix_contact_point);
}

TEST_F(EnergyRuleTest, ASurplusGivesTheOffsetBackWithinItsMeans) {
  const LocalModel moved = random_model(0.0010);
  const Vec3 x = tip(moved, 0.004, 0.0005);
  const double now = energy(moved, x, 0.0010);
  // Plenty: limited by the distance travelled, then by the value at the collision.
  EXPECT_NEAR(judge(moved, x, moved.respond(moved.deflection(x)), 10 * now, 0.0001, 2e-4).offset,
              0.0008, 1e-15);
  EXPECT_NEAR(judge(moved, x, moved.respond(moved.deflection(x)), 10 * now, 0.0009, 2e-4).offset,
              0.0009, 1e-15);
  // Scarce: limited by the budget. None: stays.
  const double budget = now + 0.3 * (energy(moved, x, 0.0008) - now);
  const double offset =
      judge(moved, x, moved.respond(moved.deflection(x)), budget, 0.0001, 2e-4).offset;
  EXPECT_LT(offset, 0.0010);
  EXPECT_NEAR(energy(moved, x, offset), budget, 1e-8 * budget);
  EXPECT_NEAR(judge(moved, x, moved.respond(moved.deflection(x)), now, 0.0001, 2e-4).offset, 0.0010,
              1e-15);
}

TEST(EnergyTank, KeepsBetweenZeroAndItsCap) {
  EnergyTank tank(0.002);
  EXPECT_EQ(tank.budget(0.001), 0.001);
  tank.settle(0.003, 0.002);  // friction paid 1 mJ
  EXPECT_NEAR(tank.level(), 0.001, 1e-18);
  EXPECT_NEAR(tank.budget(0.001), 0.002, 1e-18);
  tank.settle(0.009, 0.001);
  EXPECT_EQ(tank.level(), 0.002);
  tank.settle(0.001, 0.003);
  EXPECT_EQ(tank.level(), 0);
  EnergyTank strict(0);
  strict.settle(1, 0);
  EXPECT_EQ(strict.budget(0.5), 0.5);
}

}  // namespace
}  // namespace palpate::test
