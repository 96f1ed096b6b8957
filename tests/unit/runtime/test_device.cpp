// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/device.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "format/error.hpp"
#include "tests/unit/runtime/scripted_device.hpp"

namespace palpate::test {
namespace {

TEST(Device, HasByDefaultNoThreadAndNoKnownPeakForce) {
  ScriptedDevice device;
  EXPECT_FALSE(device.has_own_thread());
  EXPECT_TRUE(std::isnan(device.peak_force()));
  device.stop_calls();
}

TEST(Device, WithoutAThreadOfItsOwnRefusesToCallTheLoop) {
  ScriptedDevice device;
  try {
    device.start_calls([] { return false; });
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Internal);
    EXPECT_EQ(error.where(), "scripted");
  }
}

}  // namespace
}  // namespace palpate::test
