// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/large_memory.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <new>
#include <vector>

namespace palpate::test {
namespace {

using runtime::LargeMemory;

TEST(LargeMemory, AlignsSmallTablesToCacheLinesAndLargeOnesToLargePages) {
  LargeMemory<double> memory;
  double* small = memory.allocate(3);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(small) % 64, 0U);
  memory.deallocate(small, 3);
  double* large = memory.allocate(std::size_t{1} << 20);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(large) % (std::size_t{1} << 21), 0U);
  memory.deallocate(large, std::size_t{1} << 20);
}

TEST(LargeMemory, CarriesAVector) {
  std::vector<int, LargeMemory<int>> values;
  for (int i = 0; i < 1 << 20; ++i) values.push_back(i);
  EXPECT_EQ(values.front(), 0);
  EXPECT_EQ(values.back(), (1 << 20) - 1);
}

TEST(LargeMemory, RefusesASizeThatNoMachineHas) {
  LargeMemory<double> memory;
  EXPECT_THROW(memory.allocate(std::numeric_limits<std::size_t>::max() / 8), std::bad_alloc);
}

}  // namespace
}  // namespace palpate::test
