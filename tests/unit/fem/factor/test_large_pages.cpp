// SPDX-License-Identifier: AGPL-3.0-or-later
// Memory in large pages is memory: aligned where it is large, and all of it usable.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>

#include "fem/factor/large_pages.hpp"
#include "fem/factor/memory.hpp"

namespace palpate::fem {
namespace {

using Memory = std::unique_ptr<void, decltype(&std::free)>;

bool starts_at_a_large_page(const void* memory) {
  return reinterpret_cast<std::uintptr_t>(memory) % (std::uintptr_t{2} << 20) == 0;
}

TEST(LargePages, AreAlignedToAPage) {
  for (const std::size_t bytes : {kLargePagesFrom, kLargePagesFrom + 1, kLargePagesFrom + 12345}) {
    const Memory memory(allocate_in_large_pages(bytes), std::free);
    ASSERT_NE(memory, nullptr);
    EXPECT_TRUE(starts_at_a_large_page(memory.get()));
    char* text = static_cast<char*>(memory.get());
    text[0] = text[bytes - 1] = 'x';
  }
}

TEST(LargePages, AreFreedAsAnyMemory) {
  void* memory = allocate_in_large_pages(kLargePagesFrom);
  ASSERT_NE(memory, nullptr);
  static_cast<char*>(memory)[kLargePagesFrom - 1] = 'x';
  void* longer = std::realloc(memory, 2 * kLargePagesFrom);
  ASSERT_NE(longer, nullptr);
  EXPECT_EQ(static_cast<char*>(longer)[kLargePagesFrom - 1], 'x');
  std::free(longer);
  std::free(allocate_in_large_pages(1));
}

TEST(LargePages, ReturnMappedMemoryAtOnce) {
  const std::size_t bytes = 2 * kLargePagesFrom + 1;
  for (int i = 0; i < 3; ++i) {
    void* memory = map_pages(bytes);
    ASSERT_NE(memory, nullptr);
    EXPECT_TRUE(starts_at_a_large_page(memory));
    EXPECT_EQ(static_cast<char*>(memory)[bytes - 1], 0);
    std::memset(memory, 'x', bytes);
    const double with = resident_bytes();
    unmap_pages(memory, bytes);
    EXPECT_LT(resident_bytes(), with - static_cast<double>(kLargePagesFrom));
  }
}

TEST(LargePages, RefuseMoreThanTheAddressSpace) {
  EXPECT_THROW(LargePages<float>().allocate(static_cast<std::size_t>(-1) / 2), std::bad_alloc);
}

TEST(LargePages, HoldAVectorThatGrows) {
  LargeVector<float> numbers;
  const std::size_t count = kLargePagesFrom / sizeof(float) + 7;
  numbers.reserve(count);
  EXPECT_TRUE(starts_at_a_large_page(numbers.data()));
  for (std::size_t i = 0; i < count; ++i) numbers.push_back(static_cast<float>(i % 1000));
  for (std::size_t i = 0; i < count; i += 997) EXPECT_EQ(numbers[i], static_cast<float>(i % 1000));
}

}  // namespace
}  // namespace palpate::fem
