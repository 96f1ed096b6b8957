// SPDX-License-Identifier: AGPL-3.0-or-later
// The force step never allocates. malloc itself is replaced and counted, so that nothing below the
// C++ allocation functions escapes either.
#include <gtest/gtest.h>

#include <cstddef>
#include <memory>

#include "ride.hpp"

namespace {
thread_local bool counting = false;
thread_local long allocations = 0;

void note() {
  if (counting) ++allocations;
}
}  // namespace

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) {
  note();
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  note();
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  note();
  return __libc_realloc(old, size);
}
void free(void* old) {
  note();
  __libc_free(old);
}
}

namespace palpate::test {
namespace {

TEST(Step, NeverAllocatesOrFrees) {
  palpate_state state(ride_body(), {0.2, 0, runtime::EnergyBudget::Kept, 400});
  allocations = 0;
  counting = true;
  const std::uint32_t seen = ride(state);
  counting = false;
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(seen & ride_bits(), ride_bits());
}

TEST(Step, TheCounterCounts) {
  allocations = 0;
  counting = true;
  const auto one = std::make_unique<double>(1.0);
  counting = false;
  EXPECT_EQ(allocations, 1);
  EXPECT_EQ(*one, 1.0);
}

}  // namespace
}  // namespace palpate::test
