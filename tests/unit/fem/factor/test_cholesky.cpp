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

TEST(Cholesky, EliminatesTheLastUnknownsLast) {
  const Assembled a;
  const std::vector<int> last{3, 4, 5, 60, 61, 62, 90, 91, 92};
  const std::vector<int> order = nested_dissection(a.model.pattern());
  for (const auto* permutation : {static_cast<const std::vector<int>*>(nullptr), &order}) {
    const Cholesky factor(a.model.pattern(), permutation, last);
    const std::vector<int> found = factor.last_unknowns();
    EXPECT_TRUE(std::is_permutation(found.begin(), found.end(), last.begin(), last.end()));
  }
}

}  // namespace
}  // namespace palpate::fem
