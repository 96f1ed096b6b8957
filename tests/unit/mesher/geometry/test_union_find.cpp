// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/geometry/union_find.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <vector>

namespace palpate::mesher {
namespace {

TEST(UnionFind, ModuloClassesAreTheSets) {
  constexpr std::size_t kSize = 1000, kClasses = 7;
  UnionFind sets(kSize);
  std::mt19937 random(3);
  // Steps of kClasses in any order join each class and nothing else.
  std::vector<std::size_t> steps(kSize - kClasses);
  std::iota(steps.begin(), steps.end(), std::size_t{0});
  std::shuffle(steps.begin(), steps.end(), random);
  for (const std::size_t i : steps) sets.join(i, i + kClasses);
  std::set<std::size_t> roots;
  for (std::size_t i = 0; i < kSize; ++i) {
    EXPECT_EQ(sets.root(i), sets.root(i % kClasses));
    roots.insert(sets.root(i));
  }
  EXPECT_EQ(roots.size(), kClasses);
}

TEST(UnionFind, MembersThatAreNotJoinedStayAlone) {
  UnionFind sets(3);
  sets.join(0, 2);
  sets.join(2, 0);
  EXPECT_EQ(sets.root(0), sets.root(2));
  EXPECT_EQ(sets.root(1), 1U);
}

}  // namespace
}  // namespace palpate::mesher
