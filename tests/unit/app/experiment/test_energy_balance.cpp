// SPDX-License-Identifier: AGPL-3.0-or-later
// Bounds of the closed balance; that it is the margin of the simulation is verified in
// tests/verification.
#include "app/experiment/energy_balance.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace palpate::app {
namespace {

/// Without dry friction a linear spring is passive up to b/(1.5 T); friction and the curved part
/// only help.
TEST(BondedMargin, ExceedsThatOfALinearSpringWithoutFriction) {
  double last = 0;
  for (const double rate : {500.0, 1000.0, 2000.0, 8000.0}) {
    const double linear = SlingDevice{}.damping * rate / 1.5;
    const double margin = bonded_margin_by_energy_balance({}, rate, 0);
    EXPECT_GT(margin, linear) << rate;
    EXPECT_GT(margin, 1.9 * last) << rate;  // at least about in proportion to the rate
    last = margin;
  }
}

/// At 45 degrees the line strains both springs alike: k (cos^2 + sin^2) = k in the linear part, so
/// that only the curved part makes a difference; and the angles mirror there.
TEST(BondedMargin, IsSymmetricAboutTheDiagonalOfTheTwoSprings) {
  constexpr double kQuarter = std::numbers::pi / 4;
  const double less = bonded_margin_by_energy_balance({}, 2000, kQuarter - 0.2);
  const double more = bonded_margin_by_energy_balance({}, 2000, kQuarter + 0.2);
  EXPECT_NEAR(less, more, 0.05);
  EXPECT_NEAR(bonded_margin_by_energy_balance({}, 2000, 0),
              bonded_margin_by_energy_balance({}, 2000, 2 * kQuarter), 0.05);
}

}  // namespace
}  // namespace palpate::app
