// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/devices/haply.hpp"

#include <gtest/gtest.h>

#include "format/error.hpp"
#include "runtime/force_loop.hpp"
#include "runtime/handles.hpp"
#include "runtime/realtime.hpp"
#include "tests/support/bodies.hpp"
#include "tests/unit/runtime/devices/fake_haply.hpp"

namespace palpate::test {
namespace {

using runtime::DeviceReading;
using runtime::DeviceStatus;

TEST(Haply, AnswersPingsAndNoticesAHangUp) {
  FakeWorld world;
  FakeHaplyService service(world);
  runtime::HaplyDevice device({"localhost", service.port(), "049D", 2000});
  device.open();
  DeviceReading reading;
  for (int i = 0; i < 40; ++i) {
    EXPECT_EQ(device.read(reading), DeviceStatus::Good);
    EXPECT_EQ(device.command({0, 0, 0.1}), DeviceStatus::Good);
  }
  EXPECT_GT(service.pongs(), 1);
  service.hang_up();
  DeviceStatus status = DeviceStatus::Good;
  for (int i = 0; i < 1000 && status != DeviceStatus::Lost; ++i) {
    status = device.read(reading);
    device.command({});
  }
  EXPECT_EQ(status, DeviceStatus::Lost);
  EXPECT_THROW(runtime::HaplyDevice({"localhost", service.port(), "0000", 2000}).open(), Error);
}

TEST(Haply, ASilentServiceIsToldToLetGoAndTheLoopEnds) {
  FakeWorld world;
  FakeHaplyService service(world);
  runtime::HaplyDevice device({"localhost", service.port(), "049D", 2});
  const palpate_library body(plate(8, 0.08, [](const Vec3&) { return wall_response(170, 120); }));
  palpate_state state(body, {0.3, 5e-3});
  world.place({0.04, 0.04, 0.002}, {});
  device.open();
  world.pull_to({0.04, 0.04, -0.006});
  runtime::SafetySettings safety;  // of a loop of 100 Hz: patient with a busy machine
  safety.ramp = 0;
  safety.period = 0.01;
  safety.watchdog = 0.2;
  runtime::ForceLoop loop(device, state, safety, nullptr);
  const auto tick = [&] { return loop.tick(runtime::monotonic_ns()); };
  while (norm(world.last_force()) < 0.1 && tick()) continue;
  service.fall_silent();
  while (loop.counts().outdated == 0 && tick()) continue;
  while (norm(world.last_force()) > 0 && tick()) continue;
  EXPECT_EQ(norm(world.last_force()), 0);
  EXPECT_FALSE(loop.counts().lost);
  while (tick()) continue;
  EXPECT_TRUE(loop.counts().silent);
}

}  // namespace
}  // namespace palpate::test
