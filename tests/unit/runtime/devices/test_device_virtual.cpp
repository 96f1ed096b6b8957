// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/devices/device_virtual.hpp"

#include <gtest/gtest.h>

#include "runtime/realtime.hpp"
#include "tests/unit/runtime/loop_rig.hpp"

namespace palpate::test {
namespace {

using runtime::ForceLoop;
using runtime::StepQueue;

TEST(VirtualDevice, ASessionComesOutTheSameEveryTime) {
  const auto play = [] {
    runtime::SimulatedDeviceSettings settings;
    settings.hand_stiffness = 400;
    settings.hand_damping = 4;
    runtime::VirtualDevice device(settings, 1000, [](double t) {
      return runtime::HandTarget{{0.04, 0.04, 0.002 - 0.01 * t}, {0, 0, -0.01}};
    });
    device.open();
    palpate_state state(plate_body(), {0.3, 5e-3});
    StepQueue queue(2000);
    ForceLoop loop(device, state, kPatient, &queue);
    for (int i = 0; i < 1000; ++i) loop.tick(runtime::monotonic_ns());
    return drain(queue);
  };
  const auto once = play();
  const auto again = play();
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].position, again[i].position);
    EXPECT_EQ(once[i].force, again[i].force);
  }
  EXPECT_GT(once.back().force[2], 0.3);
}

}  // namespace
}  // namespace palpate::test
