// SPDX-License-Identifier: AGPL-3.0-or-later
// The force step never allocates. malloc itself is replaced and counted, so that nothing below the
// C++ allocation functions escapes either.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "format/to_index.hpp"
#include "runtime/devices/device_virtual.hpp"
#include "runtime/force_loop.hpp"
#include "runtime/realtime.hpp"
#include "runtime/skin_deformation.hpp"
#include "tests/realtime/ride.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/dimpled_skin.hpp"

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

/// A picture beside the force loop takes no lock of the allocator either.
TEST(SkinDeformation, NeverAllocatesOrFrees) {
  const Library body = plate(8, 0.08, [](const Vec3&) { return wall_response(170, 120); });
  const runtime::SkinDeformation skin(dimpled(body, skin_of(body), 0.004, 0.005), body.triangles);
  runtime::Touch touch;
  touch.point = {0, {0.5, 0.25, 0.25}};
  for (std::size_t l = 0; l < 3; ++l) {
    const std::size_t v = to_index(body.triangles[0][l]);
    touch.contact_point = touch.contact_point + touch.point.natural[l] * body.positions[v];
  }
  touch.normal = body.inward[to_index(body.triangles[0][0])];
  touch.depth = 0.003;
  touch.tip = touch.contact_point + touch.depth * touch.normal;
  std::vector<Vec3> x(skin.positions().size());
  const palpate_state state(ride_body(), {0.2, 0, runtime::EnergyBudget::Enforced, 400});
  allocations = 0;
  counting = true;
  skin.displace(touch, x.front().data());
  const bool touches = state.touch().point.element >= 0;
  counting = false;
  EXPECT_EQ(allocations, 0);
  EXPECT_FALSE(touches);
  EXPECT_NE(x, skin.positions());
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
