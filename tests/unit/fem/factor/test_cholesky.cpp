// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/cholesky.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/fem/factor/assembled_block.hpp"

namespace palpate::fem {
namespace {

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

TEST(Cholesky, RefusesAnIndefiniteMatrix) {
  Assembled a;
  a.K[to_index(a.model.pattern().start[5])] = -1;
  Cholesky factor(a.model.pattern());
  EXPECT_FALSE(factor.factorize(a.K));
}

TEST(Cholesky, EndsWithTheSchurComplementOfTheLastUnknowns) {
  const Assembled a;
  const std::vector<int> last{3, 4, 5, 60, 61, 62, 90, 91, 92};
  const std::vector<int> order = nested_dissection(a.model.pattern());
  for (const auto* permutation : {static_cast<const std::vector<int>*>(nullptr), &order}) {
    Cholesky factor(a.model.pattern(), permutation, last);
    ASSERT_TRUE(factor.factorize(a.K));
    const std::vector<int> found = factor.last_unknowns();
    ASSERT_TRUE(std::is_permutation(found.begin(), found.end(), last.begin(), last.end()));
    const Eigen::MatrixXd L = factor.last_block();
    const Eigen::MatrixXd inverse = a.dense.inverse();
    const Eigen::MatrixXd schur = inverse(found, found).inverse();
    EXPECT_LT((L * L.transpose() - schur).norm(), 1e-9 * schur.norm());
  }
}

TEST(Cholesky, EliminatesTheLastUnknownsLastInAMatrixOfSeveralParts) {
  SparsePattern pattern;  // diagonal
  pattern.n = 6;
  pattern.start = {0, 1, 2, 3, 4, 5, 6};
  pattern.row = {0, 1, 2, 3, 4, 5};
  Cholesky factor(pattern, nullptr, {0, 3});
  ASSERT_TRUE(factor.factorize({1, 4, 9, 16, 25, 36}));
  const std::vector<int> found = factor.last_unknowns();
  const std::vector<int> last{0, 3};
  EXPECT_TRUE(std::is_permutation(found.begin(), found.end(), last.begin(), last.end()));
  EXPECT_NEAR(factor.last_block().determinant(), 1 * 4, 1e-12);
}

TEST(Cholesky, ForwardAndBackwardSolvesMakeASolve) {
  const Assembled a;
  Cholesky factor(a.model.pattern(), nullptr, {10, 40});
  ASSERT_TRUE(factor.factorize(a.K));
  SolveWorkspace workspace;
  Eigen::VectorXd y(a.b.size()), x(a.b.size());
  factor.solve_forward(a.b.data(), y.data(), workspace);
  EXPECT_NEAR(y.squaredNorm(), a.b.dot(a.dense.ldlt().solve(a.b)), 1e-9 * y.squaredNorm());
  factor.solve_backward(y.data(), x.data(), workspace);
  EXPECT_LT((a.dense * x - a.b).norm(), 1e-9 * a.b.norm());
}

}  // namespace
}  // namespace palpate::fem
