// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/measurement/calibrate/descent.hpp"
#include "tests/unit/fitting/measurement/calibrate/line.hpp"

namespace palpate::calibrate {
namespace {

TEST(Descent, EndsAtTheLeastCostWithinTheBounds) {
  const Line line;
  const auto found = descend(line.problem());
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->converged);
  EXPECT_NEAR(found->at[0], line.best(), 1e-7);
  EXPECT_NEAR(found->cost, 0.5 * line.squares(line.best()), 1e-12);
  const auto bounded = descend(line.problem(0, 0.5));
  ASSERT_TRUE(bounded);
  EXPECT_NEAR(bounded->at[0], 0.5, 1e-9);
}

TEST(Descent, HasNoEndWhereTheModelHasNoValue) {
  LeastSquares problem = Line().problem();
  problem.model = [](const double*, double*, double*) { return false; };
  EXPECT_FALSE(descend(problem));
}

}  // namespace
}  // namespace palpate::calibrate
