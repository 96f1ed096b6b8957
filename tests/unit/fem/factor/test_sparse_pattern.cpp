// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/sparse_pattern.hpp"

#include <gtest/gtest.h>

#include "tests/unit/fem/factor/assembled_block.hpp"

namespace palpate::fem {
namespace {

TEST(SparsePattern, MultipliesAsTheDenseMatrix) {
  const Assembled a;
  Eigen::VectorXd y(a.b.size());
  symmetric_multiply(a.model.pattern(), a.K, a.b.data(), y.data());
  EXPECT_LT((y - a.dense * a.b).norm(), 1e-12 * y.norm());
}

TEST(SparsePattern, HasEveryEntryOfItsGroupsOnce) {
  const std::vector<std::int32_t> first{0, 2}, second{2, 3};
  const std::vector<int> equation{0, -1, 3, 6};
  const SparsePattern pattern = stiffness_pattern({first, second}, equation, 9);
  EXPECT_EQ(pattern.nonzeros(), 6 + 6 + 6 + 9 + 9);  // three diagonal blocks, two couplings
  EXPECT_EQ(pattern.position(4, 1), pattern.position(1, 4));
  EXPECT_EQ(pattern.row[to_index(pattern.position(4, 1))], 4);
  for (int column = 0; column < 9; ++column)
    EXPECT_EQ(pattern.row[to_index(pattern.start[to_index(column)])], column);
}

TEST(SparsePattern, AddsAProductOfRankOne) {
  const Assembled a;
  const SparsePattern& pattern = a.model.pattern();
  std::vector<std::int32_t> nodes;
  for (const std::int32_t node : a.model.mesh().tetrahedra.front())
    if (a.model.equation(node) >= 0) nodes.push_back(node);
  std::sort(nodes.begin(), nodes.end());
  std::vector<int> equation;
  for (int node = 0; node < a.model.mesh().nodes(); ++node)
    equation.push_back(a.model.equation(node));
  const Eigen::VectorXd g = Eigen::VectorXd::Random(3 * static_cast<Eigen::Index>(nodes.size()));
  std::vector<double> values(to_index(pattern.nonzeros()), 0.0);
  add_rank_one(pattern, equation, nodes, 2.5, g.data(), values);
  Eigen::VectorXd all = Eigen::VectorXd::Zero(pattern.n), product(pattern.n);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    all.segment<3>(a.model.equation(nodes[i])) = g.segment<3>(3 * static_cast<Eigen::Index>(i));
  symmetric_multiply(pattern, values, a.b.data(), product.data());
  EXPECT_LT((product - 2.5 * all.dot(a.b) * all).norm(), 1e-12 * product.norm());
}

}  // namespace
}  // namespace palpate::fem
