// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solve/tangent_solver.hpp"

#include <gtest/gtest.h>

#include "fem/solve/newton.hpp"
#include "tests/unit/fem/solve/pressed_body.hpp"

namespace palpate::fem {
namespace {

TEST(TangentSolver, SolvesAsAFactorOfTheTangentInFewIterations) {
  PressedBody p(2 * kToolRadius);
  TangentSolver solver(p.whole, p.window,
                       [&p](const Eigen::VectorXd& b, Eigen::VectorXd& x) { p.rest_solve(b, x); });
  NewtonSolver newton(p.whole);
  Displacement u = p.rest();
  for (const double depth : {0.001, 0.002}) {
    p.press(depth);
    ASSERT_TRUE(newton.solve(p.contact, {}, u).converged);
    ASSERT_TRUE(solver.linearize(p.contact, u));
    std::vector<double> K;
    p.whole.stiffness(u, K);
    p.contact.add_stiffness(p.whole, u, true, K);
    EXPECT_EQ(solver.values(), K);
    Cholesky factor(p.whole.pattern());
    ASSERT_TRUE(factor.factorize(K));
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(p.whole.pattern().n, -1, 2);
    Eigen::VectorXd x, exact(b.size());
    const int before = solver.iterations();
    ASSERT_TRUE(solver.solve(b, x));
    EXPECT_LE(solver.iterations() - before, 40);
    factor.solve(b.data(), exact.data(), p.workspace);
    EXPECT_LT((x - exact).norm(), 1e-4 * exact.norm());
  }
}

/// Without the contact a deeply pressed body is not stable.
TEST(TangentSolver, RefusesATangentThatIsNotPositiveDefinite) {
  PressedBody p(2 * kToolRadius);
  TangentSolver solver(p.whole, p.window,
                       [&p](const Eigen::VectorXd& b, Eigen::VectorXd& x) { p.rest_solve(b, x); });
  Displacement u = p.rest();
  for (int node = 0; node < p.whole.mesh().nodes(); ++node) {
    const double z = p.whole.mesh().X(2, node) + 0.02;
    if (p.whole.mesh().is_free(node)) u(2, node) = -0.7 * z;  // beyond any stable compression
  }
  p.press(-1);
  EXPECT_FALSE(solver.linearize(p.contact, u));
}

}  // namespace
}  // namespace palpate::fem
