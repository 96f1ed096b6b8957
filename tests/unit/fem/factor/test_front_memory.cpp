// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/front_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

namespace palpate::fem {
namespace {

constexpr std::size_t kLarge = std::size_t{1} << 18;

bool all_zero(const LargeVector<double>& memory) {
  return std::all_of(memory.begin(), memory.end(), [](double x) { return x == 0; });
}

TEST(FrontMemory, ReusesABlockAndClearsIt) {
  FrontMemory<double> pool;
  pool.keep_at_most(1e9);
  LargeVector<double> block = pool.zeros(kLarge);
  EXPECT_TRUE(all_zero(block));
  std::fill(block.begin(), block.end(), 3.0);
  const double* address = block.data();
  pool.give_back(std::move(block));
  const LargeVector<double> again = pool.zeros(kLarge - 100);
  EXPECT_EQ(again.data(), address);
  EXPECT_EQ(again.size(), kLarge - 100);
  EXPECT_TRUE(all_zero(again));
}

TEST(FrontMemory, DoesNotWasteALargeBlockOnASmallRequest) {
  FrontMemory<double> pool;
  pool.keep_at_most(1e9);
  LargeVector<double> block = pool.zeros(4 * kLarge);
  const double* address = block.data();
  pool.give_back(std::move(block));
  const LargeVector<double> small = pool.zeros(kLarge);
  EXPECT_NE(small.data(), address);
  EXPECT_LE(small.capacity(), 2 * kLarge);
}

TEST(FrontMemory, GivesTheLargestScratchThatIsLeft) {
  FrontMemory<float> pool;
  EXPECT_TRUE(pool.take_scratch().empty());
  LargeVector<float> small(10), large(kLarge);
  const float *of_large = large.data(), *of_small = small.data();
  pool.leave_scratch(std::move(large));
  pool.leave_scratch(std::move(small));
  const LargeVector<float> first = pool.take_scratch(), second = pool.take_scratch();
  EXPECT_EQ(first.data(), of_large);
  EXPECT_EQ(second.data(), of_small);
  EXPECT_TRUE(pool.take_scratch().empty());
}

}  // namespace
}  // namespace palpate::fem
