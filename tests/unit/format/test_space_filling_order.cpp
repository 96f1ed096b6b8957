// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/space_filling_order.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace palpate {
namespace {

using ::testing::ElementsAre;

TEST(SpaceFillingOrder, OfTheCornersOfABoxIsThatOfTheirBits) {
  // x changes first, then y, then z, whatever the extents.
  const std::vector<Vec3> corners{{1, 2, 3}, {0, 0, 3}, {1, 0, 0}, {0, 2, 0},
                                  {0, 2, 3}, {1, 0, 3}, {0, 0, 0}, {1, 2, 0}};
  EXPECT_THAT(space_filling_order(corners), ElementsAre(6, 2, 3, 7, 1, 5, 4, 0));
}

TEST(SpaceFillingOrder, PutsNearPointsNearEachOther) {
  std::vector<Vec3> grid;
  for (int x = 0; x < 16; ++x)
    for (int y = 0; y < 16; ++y)
      for (int z = 0; z < 16; ++z) grid.push_back({0.1 * x, 0.1 * y, 0.1 * z});
  std::mt19937 random(1);
  std::shuffle(grid.begin(), grid.end(), random);
  const std::vector<std::size_t> order = space_filling_order(grid);
  std::vector<bool> seen(grid.size(), false);
  double steps = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    EXPECT_FALSE(seen[order[i]]);
    seen[order[i]] = true;
    if (i > 0) steps += norm(grid[order[i]] - grid[order[i - 1]]);
  }
  ASSERT_EQ(order.size(), grid.size());
  // Along Z order every second step is to a neighbour; at random a step is half of the extent.
  EXPECT_LT(steps / static_cast<double>(grid.size()), 0.2);
}

TEST(SpaceFillingOrder, OfPointsInAPlaneOrOfNoneIsDefined) {
  EXPECT_TRUE(space_filling_order({}).empty());
  EXPECT_THAT(space_filling_order({{3, 1, 1}, {2, 1, 1}, {1, 1, 1}}), ElementsAre(2, 1, 0));
}

}  // namespace
}  // namespace palpate
