// SPDX-License-Identifier: AGPL-3.0-or-later
// What is particular to OpenHaptics; the rest is in test_conformance.cpp.
#include "runtime/devices/open_haptics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "format/error.hpp"
#include "tests/unit/runtime/devices/vendor_world.hpp"

namespace palpate::test {
namespace {

using runtime::DeviceReading;
using runtime::DeviceStatus;
using runtime::OpenHapticsDevice;

class OpenHaptics : public testing::Test {
 protected:
  FakeWorld& world_ = fresh_world_of("OpenHaptics");
  OpenHapticsDevice device_{{PALPATE_FAKE_HD, ""}};
};

TEST_F(OpenHaptics, KnowsThePeakForceOnceItIsOpen) {
  EXPECT_TRUE(std::isnan(device_.peak_force()));
  device_.open();
  EXPECT_EQ(device_.peak_force(), 3.3);
}

TEST_F(OpenHaptics, OpensTheDeviceThatIsNamedInTheSetupOfTheVendor) {
  device_.open();
  EXPECT_EQ(world_.opened_name, "default");
  device_.close();
  OpenHapticsDevice left({PALPATE_FAKE_HD, "Left Device"});
  left.open();
  EXPECT_EQ(world_.opened_name, "Left Device");
}

TEST_F(OpenHaptics, GivesTheCodeOfTheVendor) {
  world_.present = false;
  try {
    device_.open();
    ADD_FAILURE() << "opened a device that is not there";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("(error 0x0301)"));
  }
}

TEST_F(OpenHaptics, AnErrorOfAnEarlierSessionIsNotOneOfThis) {
  world_.queued_error = 0x0302;
  EXPECT_NO_THROW(device_.open());
  DeviceReading reading;
  EXPECT_EQ(device_.read(reading), DeviceStatus::Good);
}

/// By the ranges that the vendor documents: force errors 0x0200 to 0x0204, device errors 0x0300 to
/// 0x0304.
TEST_F(OpenHaptics, TellsErrorsOfTheForceFromThoseOfTheDevice) {
  for (const auto& [code, expected] :
       {std::pair{0x01FFU, DeviceStatus::Good}, std::pair{0x0200U, DeviceStatus::Saturated},
        std::pair{0x0204U, DeviceStatus::Saturated}, std::pair{0x0205U, DeviceStatus::Good},
        std::pair{0x02FFU, DeviceStatus::Good}, std::pair{0x0300U, DeviceStatus::Lost},
        std::pair{0x0304U, DeviceStatus::Lost}, std::pair{0x0305U, DeviceStatus::Good}}) {
    device_.open();
    DeviceReading reading;
    ASSERT_EQ(device_.read(reading), DeviceStatus::Good);
    world_.queued_error = code;
    EXPECT_EQ(device_.command({}), expected) << code;
    device_.close();
  }
}

/// After the loop there is no frame of the servo thread; a call outside of one is an error.
TEST_F(OpenHaptics, CommandsOutsideTheLoopInAFrameOfTheirOwn) {
  device_.open();
  EXPECT_EQ(device_.command({0.5, 0, 0}), DeviceStatus::Good);
  EXPECT_EQ(world_.last_force(), (Vec3{0.5, 0, 0}));
  DeviceReading reading;
  EXPECT_EQ(device_.read(reading), DeviceStatus::Good);
}

}  // namespace
}  // namespace palpate::test
