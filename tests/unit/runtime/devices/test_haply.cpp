// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/devices/haply.hpp"

#include <gtest/gtest.h>

#include "format/error.hpp"
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

}  // namespace
}  // namespace palpate::test
