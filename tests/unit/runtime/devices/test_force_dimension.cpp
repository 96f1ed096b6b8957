// SPDX-License-Identifier: AGPL-3.0-or-later
// What is particular to Force Dimension; the rest is in test_conformance.cpp.
#include "runtime/devices/force_dimension.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "format/error.hpp"
#include "tests/unit/runtime/devices/vendor_world.hpp"

namespace palpate::test {
namespace {

using runtime::DeviceStatus;
using runtime::ForceDimensionDevice;

class ForceDimension : public testing::Test {
 protected:
  FakeWorld& world_ = fresh_world_of("ForceDimension");
  ForceDimensionDevice device_{{PALPATE_FAKE_DHD, -1}};
};

TEST_F(ForceDimension, IsNamedByItsModelOnceItIsOpen) {
  EXPECT_EQ(device_.name(), "Force Dimension");
  for (const auto& [type, name] :
       {std::pair{33, "Force Dimension omega.3"}, std::pair{63, "Force Dimension delta.3"},
        std::pair{60, "Novint Falcon"}, std::pair{104, "Force Dimension sigma.7"},
        std::pair{108, "Force Dimension lambda.7"},
        std::pair{999, "Force Dimension, system type 999"}}) {
    world_.system_type = type;
    device_.open();
    EXPECT_EQ(device_.name(), name);
    device_.close();
  }
}

/// The vendor counts in 125 us.
TEST_F(ForceDimension, TheDeviceStopsItselfAfter20Milliseconds) {
  device_.open();
  EXPECT_NEAR(world_.watchdog_ticks * 125e-6, 0.020, 1e-9);
}

TEST_F(ForceDimension, OpensADeviceWithoutAWatchdog) {
  world_.has_watchdog = false;
  EXPECT_NO_THROW(device_.open());
  EXPECT_EQ(world_.watchdog_ticks, 0);
  EXPECT_EQ(device_.command({0, 0, 1}), DeviceStatus::Good);
}

TEST_F(ForceDimension, TheMotorsAreOffUntilTheFirstForce) {
  device_.open();
  EXPECT_EQ(device_.command({}), DeviceStatus::Good);
  EXPECT_FALSE(world_.forces_enabled);
  EXPECT_EQ(device_.command({0, 0, 0.5}), DeviceStatus::Good);
  EXPECT_TRUE(world_.forces_enabled);
  EXPECT_EQ(world_.last_force(), (Vec3{0, 0, 0.5}));
}

TEST_F(ForceDimension, OpensTheDeviceThatIsChosen) {
  ForceDimensionDevice first({PALPATE_FAKE_DHD, 0}), third({PALPATE_FAKE_DHD, 2});
  EXPECT_NO_THROW(first.open());
  try {
    third.open();
    ADD_FAILURE() << "there is one device only";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("no device found"));  // in the vendor's words
  }
}

}  // namespace
}  // namespace palpate::test
