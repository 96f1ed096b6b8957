// SPDX-License-Identifier: AGPL-3.0-or-later
// What every binding of a device must do, against fakes of the vendors' libraries and services: the
// binding cannot tell them from the real ones.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <thread>

#include "backends.hpp"
#include "bodies.hpp"
#include "format/error.hpp"
#include "runtime/force_loop.hpp"
#include "runtime/loop_thread.hpp"
#include "runtime/palpate.h"
#include "runtime/realtime.hpp"

namespace palpate::test {
namespace {

using runtime::Device;
using runtime::DeviceReading;
using runtime::DeviceStatus;
using runtime::ForceLoop;
using runtime::LoopThread;
using runtime::StepQueue;

const runtime::SafetySettings kPatient{0, 1000, 1000, 1e6};

/// Calls `step` as a force loop would: from here, or from the thread of the driver. Until it
/// returns false or has been called `count` times.
void in_loop(Device& device, int count, const std::function<bool(int)>& step) {
  if (!device.has_own_thread()) {
    for (int i = 0; i < count && step(i); ++i) {
    }
    return;
  }
  std::atomic<bool> done{false};
  int i = 0;
  device.start_calls([&] {
    if (i < count && step(i++)) return true;
    done = true;
    return false;
  });
  while (!done) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  device.stop_calls();
}

class Conformance : public ::testing::TestWithParam<std::size_t> {
 protected:
  void SetUp() override {
    // A service notices only by and by that the client of the test before has gone.
    for (int i = 0; i < 2000 && world().opened != world().closed; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    world().reset();
    device_ = backend().make();
  }
  Backend& backend() const { return backends()[GetParam()]; }
  FakeWorld& world() const { return *backend().world; }

  /// A force that the device cannot give, and what it says to it.
  DeviceStatus saturate() {
    world().saturated = true;
    DeviceStatus status = DeviceStatus::Good;
    in_loop(*device_, 3, [&](int) {
      DeviceReading reading;
      device_->read(reading);
      status = device_->command({40, 20, 0});
      return true;
    });
    return status;
  }

  std::unique_ptr<Device> device_;
};

TEST_P(Conformance, ReadsInSiUnits) {
  world().place({0.012, -0.034, 0.056}, {0.2, -0.1, 0.3});
  world().buttons = 5;
  device_->open();
  in_loop(*device_, 40, [&](int) {
    DeviceReading reading;
    EXPECT_EQ(device_->read(reading), DeviceStatus::Good);
    // The world moves on with a command only, so it still is where it was read.
    EXPECT_LE(norm(reading.position - world().position()), 2 * backend().position_error);
    if (backend().gives_velocity) {
      EXPECT_LE(norm(reading.velocity - world().velocity()), 1e-12);
    }
    device_->command({});
    return true;
  });
  EXPECT_GT(norm(world().position() - Vec3{0.012, -0.034, 0.056}), 1e-4);
  EXPECT_NE(device_->name(), "");
}

TEST_P(Conformance, CommandsInSiUnits) {
  device_->open();
  in_loop(*device_, 30, [&](int i) {
    DeviceReading reading;
    device_->read(reading);
    const Vec3 sent{std::sin(i), 1.5 * std::cos(i), -0.7 * std::sin(2 * i)};
    const Vec3 before{std::sin(i - 1), 1.5 * std::cos(i - 1), -0.7 * std::sin(2 * (i - 1))};
    if (i > 0) {
      EXPECT_LE(norm(world().last_force() - before), 2 * backend().force_error);
    }
    EXPECT_EQ(device_->command(sent), DeviceStatus::Good);
    return true;
  });
}

TEST_P(Conformance, FeelsABody) {
  // The hand pulls the tip into a plate: at rest its force is that of the plate, and what the
  // device was commanded. Through binding, loop and contact.
  const palpate_library body(plate(8, 0.08, [](const Vec3&) { return wall_response(170, 120); }));
  palpate_state state(body, {0.3, 5e-3});
  world().place({0.04, 0.04, 0.002}, {});
  device_->open();
  world().pull_to({0.04, 0.04, -0.006});
  ForceLoop loop(*device_, state, kPatient, nullptr);
  in_loop(*device_, 1500, [&](int) { return loop.tick(runtime::monotonic_ns()); });
  const double z = state.contact.observation().deflection.depth;
  const double wall = z < 0.005 ? 100 * 170 * z * z : 170 * (z - 0.0025);
  EXPECT_GT(wall, 0.1);
  EXPECT_NEAR(-world().hand_force()[2], wall, 0.01 * wall);
  EXPECT_FALSE(loop.counts().lost);
}

TEST_P(Conformance, WithoutADeviceItSaysSoAndWhatToDo) {
  world().present = false;
  try {
    device_->open();
    ADD_FAILURE() << "opened a device that is not there";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_NE(error.remedy().find("check"), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
  DeviceReading reading;
  EXPECT_EQ(device_->read(reading), DeviceStatus::Lost);
  device_->close();
  // Plugged in, the same object works.
  world().present = true;
  EXPECT_NO_THROW(device_->open());
}

TEST_P(Conformance, WithoutItsDriverItSaysWhatIsMissing) {
  try {
    backend().make_without_driver()->open();
    ADD_FAILURE() << "opened without a driver";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_NE(std::string(error.what()).find(backend().driver_word), std::string::npos)
        << error.what();
    EXPECT_FALSE(error.remedy().empty());
  }
}

TEST_P(Conformance, UnpluggedInTheLoopItIsLostAndTheLoopEnds) {
  const palpate_library body(plate(4, 0.08, [](const Vec3&) { return wall_response(170, 120); }));
  palpate_state state(body, {0.3, 5e-3});
  StepQueue queue(256);
  device_->open();
  ForceLoop loop(*device_, state, kPatient, &queue);
  int ticks = 0;
  in_loop(*device_, 200, [&](int i) {
    if (i == 60) world().unplugged = true;
    ++ticks;
    return loop.tick(runtime::monotonic_ns());
  });
  EXPECT_TRUE(loop.counts().lost);
  EXPECT_GE(ticks, 61);
  EXPECT_LE(ticks, 63);
  EXPECT_EQ(queue.size_approx(), static_cast<std::size_t>(ticks));  // all that was recorded is kept
  device_->close();
  world().unplugged = false;
  EXPECT_NO_THROW(device_->open());
}

TEST_P(Conformance, SaysWhenItSaturates) {
  if (backend().name == "Haply") GTEST_SKIP() << "its service does not say";
  device_->open();
  EXPECT_EQ(saturate(), DeviceStatus::Saturated);
}

TEST_P(Conformance, SaysWhenASampleIsLateAndGoesOn) {
  if (!backend().reports_late) GTEST_SKIP() << "this driver has no such notion";
  device_->open();
  DeviceReading reading;
  device_->read(reading);
  device_->command({});
  device_->read(reading);
  const Vec3 before = reading.position;
  world().late = true;
  device_->command({0.1, 0, 0});
  EXPECT_EQ(device_->read(reading), DeviceStatus::Late);
  EXPECT_LE(norm(reading.position - before), 1e-3);
  device_->command({0.1, 0, 0});
  world().late = false;
  DeviceStatus status = DeviceStatus::Late;
  for (int i = 0; i < 100 && status == DeviceStatus::Late; ++i) status = device_->read(reading);
  EXPECT_EQ(status, DeviceStatus::Good);
  EXPECT_EQ(device_->command({0.2, 0, 0}), DeviceStatus::Good);
}

TEST_P(Conformance, CloseLeavesNoForceAndMayComeTwice) {
  device_->open();
  in_loop(*device_, 5, [&](int) {
    DeviceReading reading;
    device_->read(reading);
    device_->command({1, 1, 1});
    return true;
  });
  device_->close();
  device_->close();
  for (int i = 0; i < 1000 && world().closed == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_LE(norm(world().last_force()), 2 * backend().force_error);
  EXPECT_EQ(world().closed, 1);
  DeviceReading reading;
  EXPECT_EQ(device_->read(reading), DeviceStatus::Lost);
  EXPECT_EQ(device_->command({1, 0, 0}), DeviceStatus::Lost);
}

TEST_P(Conformance, HaltedFromAnotherThreadItGivesNoForceAgain) {
  device_->open();
  in_loop(*device_, 40, [&](int i) {
    DeviceReading reading;
    device_->read(reading);
    if (i == 15) {
      EXPECT_GT(norm(world().last_force()), 0.5);
      std::thread([&] { device_->halt(); }).join();
    }
    device_->command({1, 1, 1});
    // Haply answers later: two messages may be on their way.
    if (i > 20) {
      EXPECT_LE(norm(world().last_force()), 2 * backend().force_error);
    }
    return true;
  });
}

TEST_P(Conformance, ALoopThreadDrivesItWhateverThreadThatIs) {
  const palpate_library body(plate(4, 0.08, [](const Vec3&) { return wall_response(170, 120); }));
  palpate_state state(body, {0.3, 5e-3});
  device_->open();
  ForceLoop loop(*device_, state, kPatient, nullptr);
  runtime::LoopThreadSettings settings;
  settings.rate = 500;
  settings.watchdog = 10;
  settings.realtime.priority = 0;
  {
    LoopThread thread(loop, *device_, settings);
    for (int i = 0; i < 2000 && world().forces < 12; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    thread.stop();
    EXPECT_FALSE(thread.running());
  }
  EXPECT_GT(loop.counts().steps, 10U);
  EXPECT_FALSE(loop.counts().lost);
}

INSTANTIATE_TEST_SUITE_P(Device, Conformance, ::testing::Range(std::size_t{0}, std::size_t{4}),
                         [](const auto& about) { return backends()[about.param].name; });

}  // namespace
}  // namespace palpate::test
