// SPDX-License-Identifier: AGPL-3.0-or-later
// The force step never allocates. malloc itself is replaced and counted, so that nothing below the
// C++ allocation functions escapes either.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <memory>

#include "runtime/devices/device_virtual.hpp"
#include "runtime/force_loop.hpp"
#include "runtime/realtime.hpp"
#include "tests/realtime/ride.hpp"

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
  palpate_state state(ride_body(), {0.2, 0, runtime::EnergyBudget::Enforced, 400});
  allocations = 0;
  counting = true;
  const std::uint32_t seen = ride(state);
  counting = false;
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(seen & ride_bits(), ride_bits());
}

TEST(ForceLoop, NeverAllocatesOrFreesInATick) {
  runtime::SimulatedDeviceSettings settings;
  settings.hand_stiffness = 400;
  settings.hand_damping = 4;
  runtime::VirtualDevice device(settings, 1000, [](double t) {
    return runtime::HandTarget{{0.03 * std::cos(t), 0.03 * std::sin(t), 0.01 * t}, {}};
  });
  device.open();
  palpate_state state(ride_body(), {0.2, 5e-3, runtime::EnergyBudget::Enforced, 400}, 200);
  runtime::StepQueue queue(1000);
  runtime::ForceLoop loop(device, state, {}, &queue);
  allocations = 0;
  counting = true;
  for (int i = 0; i < 5000; ++i) loop.tick(runtime::monotonic_ns());
  counting = false;
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(loop.counts().steps, 5000U);
  EXPECT_EQ(loop.counts().unrecorded, 4000U);
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
