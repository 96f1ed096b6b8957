// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/elimination_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/fem/factor/assembled_block.hpp"

namespace palpate::fem {
namespace {

class Plan : public testing::Test {
 protected:
  Body body =
      test::make_block(test::even(0, 0.02, 6), test::even(0, 0.02, 6), test::even(0, 0.02, 6));
  SolidModel model{body, {NeoHookean::from_young_poisson(10e3, 0.45, "t")}};
  std::vector<int> order = nested_dissection(model.pattern());
  Cholesky analysis{model.pattern(), &order};
  EliminationTree tree{analysis.view()};
};

TEST_F(Plan, TreeHasChildrenBeforeParentsAndAllColumns) {
  int columns = 0;
  for (int k = 0; k < tree.supernodes(); ++k) {
    columns += tree.columns[to_index(k)];
    const int parent = tree.parent[to_index(k)];
    if (parent >= 0) {
      EXPECT_GT(parent, k);
      const auto& children = tree.children[to_index(parent)];
      EXPECT_EQ(std::count(children.begin(), children.end(), k), 1);
    }
    EXPECT_EQ(parent < 0, tree.below(k) == 0);
  }
  EXPECT_EQ(columns, model.pattern().n);
}

TEST_F(Plan, HasEverySupernodeOnceWithItsChildrenBelow) {
  for (const int threads : {1, 2, 5}) {
    const EliminationPlan plan(tree, threads);
    std::vector<int> owner(tree.parent.size(), -2);  // -1: the top
    const auto take = [&](int k, int part) {
      EXPECT_EQ(owner[to_index(k)], -2);
      owner[to_index(k)] = part;
    };
    for (std::size_t i = 0; i < plan.parts.size(); ++i)
      for (const int k : plan.parts[i]) take(k, static_cast<int>(i));
    for (const int k : plan.top) take(k, -1);
    for (int k = 0; k < tree.supernodes(); ++k) {
      EXPECT_NE(owner[to_index(k)], -2);
      for (const int child : tree.children[to_index(k)])
        if (owner[to_index(k)] >= 0) {
          EXPECT_EQ(owner[to_index(child)], owner[to_index(k)]);
        }
    }
    EXPECT_EQ(threads == 1, plan.parts.size() == 1 && plan.top.empty());
    EXPECT_GT(plan.update_numbers, 0);
    EXPECT_GT(plan.column_numbers, 0);
  }
}

TEST_F(Plan, GivesEveryThreadWork) {
  const EliminationPlan plan(tree, 2);
  EXPECT_GE(plan.parts.size(), 2u);
  const auto work = [&](const std::vector<int>& part) {
    double sum = 0;
    for (const int k : part) sum += tree.work(k);
    return sum;
  };
  for (std::size_t i = 1; i < plan.parts.size(); ++i)
    EXPECT_LE(work(plan.parts[i]), work(plan.parts[i - 1]) * (1 + 1e-12));
}

}  // namespace
}  // namespace palpate::fem
