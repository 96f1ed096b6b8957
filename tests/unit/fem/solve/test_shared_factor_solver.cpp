// SPDX-License-Identifier: AGPL-3.0-or-later
// The solver that never factorizes the deformed body, against Newton's method, which does.
#include "fem/solve/shared_factor_solver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/unit/fem/solve/pressed_body.hpp"

namespace palpate::fem {
namespace {

constexpr double kTolerance = 1e-5;

SharedFactorSolver solver_of(PressedBody& p) {
  return {p.whole,
          p.window,
          [&p](const Eigen::VectorXd& b, Eigen::VectorXd& x) { p.rest_solve(b, x); },
          {[&p](const Displacement& u) { return p.turned_solve(u); }, 15, 0, 0},
          SharedFactorSolver::kFewPairs};
}

Displacement by_newton(const PressedBody& p, Displacement u) {
  NewtonSolver newton(p.whole);
  const NewtonResult result = newton.solve(p.contact, {.tolerance = 1e-9}, u);
  EXPECT_TRUE(result.converged) << result.reason;
  return u;
}

void expect_equilibrium(const PressedBody& p, const Displacement& u) {
  const Equilibrium now = evaluate(p.whole, p.contact, u);
  EXPECT_GT(now.min_J, 0);
  EXPECT_LE(now.residual.norm(), kTolerance * p.contact.tool_force(u).norm());
}

void expect_same_state(const PressedBody& p, const Displacement& u, const Displacement& expected) {
  const Eigen::Vector3d force = p.contact.tool_force(expected);
  EXPECT_LT((p.contact.tool_force(u) - force).norm(), 2 * kTolerance * force.norm());
  EXPECT_LT((u - expected).norm(), 1e-4 * expected.norm());
}

void expect_state_of(const SolidModel& model, const Displacement& u, const NewtonResult& result) {
  ASSERT_TRUE(result.solid);
  const SolidModel::State state = model.energy(u);
  EXPECT_DOUBLE_EQ(result.solid->energy, state.energy);
  EXPECT_DOUBLE_EQ(result.solid->volume, state.volume);
  EXPECT_DOUBLE_EQ(result.solid->min_J, state.min_J);
}

/// Presses to one depth after the other, each as Newton's method does.
void expect_newtons_equilibria(const std::vector<double>& depths) {
  PressedBody p(2 * kToolRadius);
  SharedFactorSolver solver = solver_of(p);
  Displacement u = p.rest();
  for (const double depth : depths) {
    p.press(depth);
    const NewtonResult result = solver.solve(p.contact, {.tolerance = kTolerance}, u);
    ASSERT_TRUE(result.converged) << result.reason;
    EXPECT_LE(result.iterations, 15) << depth;
    expect_equilibrium(p, u);
    expect_same_state(p, u, by_newton(p, u));
    expect_state_of(p.whole, u, result);
  }
}

TEST(SharedFactorSolver, FindsTheEquilibriumOfNewtonsMethodInFewIterations) {
  expect_newtons_equilibria({0.0001, 0.0005, 0.001, 0.0015, 0.002});
}

/// The contact grows to many facets and shrinks to few, which makes another patch worthwhile.
TEST(SharedFactorSolver, FollowsALiftedTool) {
  expect_newtons_equilibria({0.001, 0.002, 0.001, 0.0004, 0.0001, 0.002});
}

class NearlyIncompressible : public testing::TestWithParam<Dilatation> {};

/// Without multipliers an increment takes hundreds of steps at nu = 0.4999.
TEST_P(NearlyIncompressible, EquilibriaTakeFewIterations) {
  for (const double poisson : {0.499, 0.49999}) {
    PressedBody p(2 * kToolRadius, poisson, GetParam());
    SharedFactorSolver solver = solver_of(p);
    Displacement u = p.rest();
    p.press(0);
    solver.start_path(p.contact.tool().tip, u);
    for (const double depth : {0.0007, 0.0014}) {
      p.press(depth);
      const NewtonResult result = solver.solve(p.contact, {.tolerance = kTolerance}, u);
      ASSERT_TRUE(result.converged) << result.reason;
      EXPECT_LE(result.iterations, 25) << depth;
      EXPECT_FALSE(result.solid);  // its energy is that of the augmented law
      expect_same_state(p, u, by_newton(p, u));
    }
  }
}

/// As after an increment that Newton's method had to find.
TEST_P(NearlyIncompressible, GoesOnFromAnEquilibriumOfAnotherSolver) {
  PressedBody p(2 * kToolRadius, 0.4999, GetParam());
  SharedFactorSolver solver = solver_of(p);
  p.press(0.001);
  Displacement u = by_newton(p, p.rest());
  solver.accept(p.contact.tool().tip, u);
  p.press(0.0014);
  ASSERT_TRUE(solver.solve(p.contact, {.tolerance = kTolerance}, u).converged);
  expect_same_state(p, u, by_newton(p, u));
}

INSTANTIATE_TEST_SUITE_P(Pressures, NearlyIncompressible,
                         testing::Values(Dilatation::Mean, Dilatation::Nodal));

/// Contact beyond the window is stiffness that K0 does not have: the solver may fail, with a
/// reason, and Newton's method takes over as in a campaign. What it finds is the equilibrium all
/// the same.
TEST(SharedFactorSolver, IsRightOrFailsWhereTheContactOutgrowsTheWindow) {
  constexpr double kWindow = 0.43 * kToolRadius;
  PressedBody p(kWindow);
  SharedFactorSolver solver = solver_of(p);
  Displacement u = p.rest();
  int converged = 0;
  double radius = 0;
  for (const double depth : {0.0001, 0.0005, 0.001, 0.0015, 0.002}) {
    p.press(depth);
    Displacement trial = u;
    const NewtonResult result =
        solver.solve(p.contact, {.tolerance = kTolerance, .max_iterations = 200}, trial);
    u = by_newton(p, u);
    if (result.converged) {
      ++converged;
      expect_equilibrium(p, trial);
      expect_same_state(p, trial, u);
    } else {
      EXPECT_FALSE(result.reason.empty());
      solver.restart();
    }
    radius = std::sqrt(p.contact.contact_area(u) / M_PI);
  }
  EXPECT_GE(converged, 1);
  EXPECT_GT(radius, kWindow);
}

TEST(SharedFactorSolver, DoesNotDependOnEarlierCurvaturePairs) {
  PressedBody p(2 * kToolRadius);
  SharedFactorSolver fresh = solver_of(p), used = solver_of(p);
  Displacement u = p.rest(), v = p.rest();
  p.press(0.002);
  ASSERT_TRUE(used.solve(p.contact, {.tolerance = kTolerance}, v).converged);
  p.press(0.001);
  ASSERT_TRUE(used.solve(p.contact, {.tolerance = kTolerance}, v).converged);
  ASSERT_TRUE(fresh.solve(p.contact, {.tolerance = kTolerance}, u).converged);
  const Displacement exact = by_newton(p, u);
  expect_same_state(p, v, exact);
  expect_same_state(p, u, exact);
}

TEST(SharedFactorSolver, ReturnsAReasonWhereItDoesNotConverge) {
  PressedBody p(2 * kToolRadius);
  SharedFactorSolver solver = solver_of(p);
  p.press(0.001);
  Displacement u = p.rest();
  const NewtonResult result = solver.solve(p.contact, {.tolerance = 1e-12, .max_iterations = 2}, u);
  EXPECT_FALSE(result.converged);
  EXPECT_THAT(result.reason, testing::HasSubstr("no convergence in 2 iterations"));
}

}  // namespace
}  // namespace palpate::fem
