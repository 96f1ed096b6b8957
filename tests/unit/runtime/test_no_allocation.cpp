// SPDX-License-Identifier: AGPL-3.0-or-later
// The force step never allocates. malloc itself is replaced and counted, so that nothing below the
// C++ allocation functions escapes either.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>

#include "bodies.hpp"
#include "runtime/handles.hpp"
#include "runtime/palpate.h"

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
  const palpate_library body(bumpy_sphere(4, 0.03, 0.2, [](const Vec3& x) {
    return wall_response(170 * (1 + 0.6 * std::sin(150 * x[2])), 100);
  }));
  palpate_state state(body, {0.2, 5e-3});
  const double velocity[3] = {0, 0, 0};
  double force[3];
  std::uint32_t seen = 0;
  allocations = 0;
  counting = true;
  const auto step = [&](const Vec3& x) {
    seen |= palpate_step(&state, x.data(), velocity, 1e-3, force);
  };
  for (int i = 0; i < 60000; ++i) {  // in, sliding all around, out, and back
    const double a = 2e-3 * i;
    const double r = 0.031 + 0.008 * std::cos(5e-4 * i);
    step(r * Vec3{std::cos(a), 0.8 * std::sin(a), 0.6 * std::sin(a)});
  }
  step({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  step({1e300, 0, 0});
  palpate_observation observation{};
  observation.size = sizeof observation;
  palpate_observe(&state, &observation);
  counting = false;
  EXPECT_EQ(allocations, 0);
  // The walk met everything a step can do.
  for (const std::uint32_t bit :
       {PALPATE_CONTACT, PALPATE_ACTIVATED, PALPATE_RELEASED, PALPATE_SLIDING, PALPATE_BAD_INPUT}) {
    EXPECT_TRUE(seen & bit) << bit;
  }
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
