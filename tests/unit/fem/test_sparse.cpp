// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numeric>

#include "fem/linear_solver.hpp"
#include "fem/solid_model.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

struct Assembled {
  Body body =
      test::make_block(test::even(0, 0.02, 2), test::even(0, 0.02, 2), test::even(0, 0.02, 2));
  SolidModel model{body, {NeoHookean::from_young_poisson(10e3, 0.49, "t")}};
  std::vector<double> K;
  Eigen::MatrixXd dense;
  Eigen::VectorXd b;

  Assembled() {
    const auto& pattern = model.pattern();
    model.stiffness(Displacement::Zero(3, model.mesh().nodes()), K);
    dense = Eigen::MatrixXd::Zero(pattern.n, pattern.n);
    for (int c = 0; c < pattern.n; ++c)
      for (int at = pattern.start[c]; at < pattern.start[c + 1]; ++at)
        dense(pattern.row[at], c) = dense(c, pattern.row[at]) = K[at];
    b = Eigen::VectorXd::Random(pattern.n);
  }
};

TEST(SparsePattern, ProductEqualsTheDenseOne) {
  const Assembled a;
  Eigen::VectorXd y(a.b.size());
  symmetric_multiply(a.model.pattern(), a.K, a.b.data(), y.data());
  EXPECT_LT((y - a.dense * a.b).norm(), 1e-12 * y.norm());
}

TEST(SparsePattern, SubmatrixKeepsTheEntries) {
  const Assembled a;
  const std::vector<int> kept{0, 1, 2, 9, 10, 11, 30, 31, 32};
  const Submatrix sub = principal_submatrix(a.model.pattern(), kept);
  for (int c = 0; c < sub.pattern.n; ++c)
    for (int at = sub.pattern.start[c]; at < sub.pattern.start[c + 1]; ++at)
      EXPECT_EQ(a.K[sub.source[at]], a.dense(kept[sub.pattern.row[at]], kept[c]));
}

TEST(Cholesky, SolvesAsADenseFactorizationDoes) {
  const Assembled a;
  Cholesky factor(a.model.pattern());
  ASSERT_TRUE(factor.factorize(a.K));
  SolveWorkspace workspace;
  Eigen::VectorXd x(a.b.size());
  factor.solve(a.b.data(), x.data(), workspace);
  const Eigen::VectorXd expected = a.dense.ldlt().solve(a.b);
  EXPECT_LT((x - expected).norm(), 1e-9 * expected.norm());
}

TEST(Cholesky, SaysWhenTheMatrixIsIndefinite) {
  Assembled a;
  a.K[a.model.pattern().start[5]] = -1;
  Cholesky factor(a.model.pattern());
  EXPECT_FALSE(factor.factorize(a.K));
}

TEST(TwoLevelSolver, SolvesAMatrixThatDiffersFromTheRestStiffness) {
  const Assembled a;
  Cholesky rest(a.model.pattern());
  ASSERT_TRUE(rest.factorize(a.K));
  // A flattened state of unchanged volume; the window is a third of the body.
  Displacement u = Displacement::Zero(3, a.model.mesh().nodes());
  u.row(2) = -0.15 * a.model.mesh().X.row(2);
  u.topRows(2) = (1 / std::sqrt(0.85) - 1) * a.model.mesh().X.topRows(2);
  std::vector<double> K;
  a.model.stiffness(u, K);
  std::vector<int> window(a.model.pattern().n / 9 * 3);
  std::iota(window.begin(), window.end(), a.model.pattern().n - static_cast<int>(window.size()));
  TwoLevelSolver solver(a.model.pattern(), rest, window);
  Eigen::VectorXd d, product(a.b.size());
  ASSERT_TRUE(solver.solve(K, a.b, 1e-8, d));
  symmetric_multiply(a.model.pattern(), K, d.data(), product.data());
  EXPECT_LT((product - a.b).norm(), 1e-7 * a.b.norm());
}

}  // namespace
}  // namespace palpate::fem
