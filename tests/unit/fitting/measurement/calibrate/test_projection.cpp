// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/measurement/calibrate/projection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fitting/measurement/calibrate/descent.hpp"
#include "format/numbers.hpp"

namespace palpate::calibrate {
namespace {

/// a exp(-p x) + b exp(-q x) at 12 places, from a = 3, p = 1, b = 2, q = 4.
LeastSquares decays(double low = -kInfinity) {
  LeastSquares problem;
  problem.constants = {{"a", "1", 1, low, kInfinity, false, false, true},
                       {"p", "1", 0.5, 0, 20},
                       {"b", "1", 1, low, kInfinity, false, false, true},
                       {"q", "1", 6, 0, 20}};
  problem.residuals = 12;
  problem.model = [](const double* c, double* r, double* J) {
    for (int i = 0; i < 12; ++i) {
      const double x = 0.25 * i, e = std::exp(-c[1] * x), f = std::exp(-c[3] * x);
      r[i] = c[0] * e + c[2] * f - 3 * std::exp(-x) - 2 * std::exp(-4 * x);
      if (J != nullptr) J[4 * i] = e, J[4 * i + 1] = -c[0] * x * e;
      if (J != nullptr) J[4 * i + 2] = f, J[4 * i + 3] = -c[2] * x * f;
    }
    return true;
  };
  return problem;
}

/// The minimum in the rates alone is that in all constants.
TEST(Projection, HasTheMinimumOfTheWholeProblem) {
  const LeastSquares problem = decays();
  const Projection projection(problem);
  ASSERT_TRUE(projection.is_useful());
  const LeastSquares reduced = projection.reduced();
  ASSERT_EQ(reduced.constants.size(), 2U);
  const auto end = descend(reduced);
  ASSERT_TRUE(end);
  EXPECT_NEAR(end->at[0], 1, 1e-6);
  EXPECT_NEAR(end->at[1], 4, 1e-6);
  std::vector<double> all;
  ASSERT_TRUE(projection.expand(end->at.data(), all));
  EXPECT_NEAR(all[0], 3, 1e-5);
  EXPECT_NEAR(all[2], 2, 1e-5);
}

/// The slope of half the sum of squares by a rate, with the amplitudes at their best, by
/// differences: Kaufman's Jacobian leaves out what does not change it.
TEST(Projection, HasTheSlopeOfItsCost) {
  const LeastSquares problem = decays();
  const Projection projection(problem);
  const LeastSquares reduced = projection.reduced();
  const std::vector<double> at{0.7, 5};
  std::vector<double> r(12), J(24);
  const auto cost = [&](double p, double q) {
    const double here[] = {p, q};
    EXPECT_TRUE(reduced.model(here, r.data(), nullptr));
    double sum = 0;
    for (const double value : r) sum += 0.5 * value * value;
    return sum;
  };
  constexpr double h = 1e-5;
  const double by_p = (cost(at[0] + h, at[1]) - cost(at[0] - h, at[1])) / (2 * h);
  const double by_q = (cost(at[0], at[1] + h) - cost(at[0], at[1] - h)) / (2 * h);
  ASSERT_TRUE(reduced.model(at.data(), r.data(), J.data()));
  double p = 0, q = 0;
  for (std::size_t i = 0; i < 12; ++i) p += J[2 * i] * r[i], q += J[2 * i + 1] * r[i];
  EXPECT_NEAR(p, by_p, 1e-6 * std::abs(by_p));
  EXPECT_NEAR(q, by_q, 1e-6 * std::abs(by_q));
}

/// An amplitude whose best value is negative stays at its bound, and the other one is then alone.
TEST(Projection, KeepsLinearConstantsWithinTheirBounds) {
  const LeastSquares problem = decays(0);
  const Projection projection(problem);
  std::vector<double> all;
  const double rates[] = {2, 2.5};  // between the true ones: the best amplitudes differ in sign
  const LeastSquares unbounded = decays();
  ASSERT_TRUE(Projection(unbounded).expand(rates, all));
  ASSERT_LT(all[0] * all[2], 0);
  ASSERT_TRUE(projection.expand(rates, all));
  EXPECT_EQ(std::min(all[0], all[2]), 0);
  EXPECT_GT(std::max(all[0], all[2]), 0);
}

TEST(Projection, NeedsConstantsOfBothKinds) {
  LeastSquares problem = decays();
  for (Constant& c : problem.constants) c.linear = false;
  EXPECT_FALSE(Projection(problem).is_useful());
  for (Constant& c : problem.constants) c.linear = true;
  EXPECT_FALSE(Projection(problem).is_useful());
}

}  // namespace
}  // namespace palpate::calibrate
