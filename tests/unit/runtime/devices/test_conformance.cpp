// SPDX-License-Identifier: AGPL-3.0-or-later
// What every binding of a device must do, against fakes of the vendors' libraries and services: the
// binding cannot tell them from the real ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <thread>

#include "format/error.hpp"
#include "runtime/devices/device_virtual.hpp"
#include "runtime/force_loop.hpp"
#include "runtime/handles.hpp"
#include "runtime/loop_thread.hpp"
#include "runtime/palpate.h"
#include "runtime/realtime.hpp"
#include "tests/support/bodies.hpp"
#include "tests/unit/runtime/devices/backends.hpp"

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
  device_->open();
  EXPECT_EQ(saturate(), DeviceStatus::Saturated);
}

/// The drivers that know when a sample is late.
class LateConformance : public Conformance {};

TEST_P(LateConformance, SaysWhenASampleIsLateAndGoesOn) {
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

TEST_P(Conformance, AStallOfTheDriverCutsTheForceOffAndItComesBackAsTheTipMoves) {
  const palpate_library body(plate(8, 0.08, [](const Vec3&) { return wall_response(170, 120); }));
  palpate_state state(body, {0.3, 5e-3});
  runtime::SafetySettings safety = kPatient;
  safety.watchdog = 0.1;
  StepQueue queue(1 << 16);
  world().place({0.04, 0.04, 0.002}, {});
  device_->open();
  world().pull_to({0.04, 0.04, -0.006});
  ForceLoop loop(*device_, state, safety, &queue);
  int stalled_at = -1;
  bool was_cut = false;
  in_loop(*device_, 60000, [&](int i) {
    if (stalled_at < 0 && norm(world().last_force()) > 0.2) {
      world().stall_ms = 150;
      stalled_at = i;
    }
    const double given = norm(world().last_force());
    if (!was_cut && loop.counts().late > 0 && given < 0.01) {
      was_cut = true;
      world().pull_to({0.04, 0.04, -0.02});  // deeper, against the plate again
    }
    return loop.tick(runtime::monotonic_ns()) && !(was_cut && given > 0.2);
  });
  ASSERT_GT(stalled_at, 0);
  EXPECT_EQ(loop.counts().unrecorded, 0U);
  EXPECT_GE(loop.counts().late, 1U);
  EXPECT_FALSE(loop.counts().lost);
  RecordedStep step;
  Vec3 before{};  // tip of the step before
  double last = 0, stiffest = 0;
  while (queue.try_dequeue(step)) {
    if (step.status & PALPATE_LOOP_LATE) {
      EXPECT_EQ(norm(step.force), 0);
    } else if (step.time_ns > 0) {
      const double moved = std::max(norm(step.position - before), 1e-6);
      stiffest = std::max(stiffest, (norm(step.force) - last) / moved);
    }
    last = norm(step.force);
    before = step.position;
  }
  EXPECT_LT(stiffest, 171);  // no step brings back more force than its motion
  EXPECT_GT(last, 0.1);      // and it is felt again
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

std::vector<std::size_t> backends_that_report_late() {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < backends().size(); ++i)
    if (backends()[i].reports_late) chosen.push_back(i);
  return chosen;
}

INSTANTIATE_TEST_SUITE_P(Device, LateConformance, ::testing::ValuesIn(backends_that_report_late()),
                         [](const auto& about) { return backends()[about.param].name; });

/// The simulated device has no driver that could fail; what the interface promises it keeps too.
class SimulatedConformance : public ::testing::Test {
 protected:
  static runtime::VirtualDevice make() {
    runtime::SimulatedDeviceSettings settings;
    settings.hand_stiffness = 200;
    settings.hand_damping = 2;
    return {settings, 1000, [](double) { return runtime::HandTarget{{0.04, 0.04, -0.006}, {}}; }};
  }
  DeviceReading reading_;
};

TEST_F(SimulatedConformance, ClosedItIsLostAndOpensAgain) {
  runtime::VirtualDevice device = make();
  EXPECT_EQ(device.read(reading_), DeviceStatus::Lost);
  EXPECT_EQ(device.command({}), DeviceStatus::Lost);
  device.open();
  EXPECT_EQ(device.read(reading_), DeviceStatus::Good);
  EXPECT_EQ(device.command({}), DeviceStatus::Good);
  device.close();
  device.close();
  EXPECT_EQ(device.read(reading_), DeviceStatus::Lost);
  device.open();
  EXPECT_EQ(device.read(reading_), DeviceStatus::Good);
}

TEST_F(SimulatedConformance, HaltedItMovesAsWithoutForce) {
  runtime::VirtualDevice halted = make(), free = make();
  halted.open();
  free.open();
  std::thread([&] { halted.halt(); }).join();
  DeviceReading expected;
  for (int i = 0; i < 500; ++i) {
    ASSERT_EQ(halted.command({3, -2, 1}), DeviceStatus::Good);
    free.command({});
    halted.read(reading_);
    free.read(expected);
    ASSERT_EQ(reading_.position, expected.position);
  }
}

TEST_F(SimulatedConformance, FeelsABody) {
  const palpate_library body(plate(8, 0.08, [](const Vec3&) { return wall_response(170, 120); }));
  palpate_state state(body, {0.3, 5e-3});
  runtime::SimulatedDeviceSettings settings;
  settings.damping = 2;
  settings.hand_stiffness = 200;
  runtime::VirtualDevice device(settings, 1000, [](double t) {
    return runtime::HandTarget{{0.04, 0.04, std::max(-0.006, 0.002 - 0.02 * t)}, {}};
  });
  device.open();
  ForceLoop loop(device, state, kPatient, nullptr);
  for (int i = 0; i < 3000; ++i) ASSERT_TRUE(loop.tick(runtime::monotonic_ns()));
  const double z = state.contact.observation().deflection.depth;
  const double wall = z < 0.005 ? 100 * 170 * z * z : 170 * (z - 0.0025);
  device.read(reading_);
  EXPECT_GT(wall, 0.1);
  EXPECT_NEAR(200 * (reading_.position[2] + 0.006), wall, 0.03 * wall);  // dry friction: 0.01 N
}

}  // namespace
}  // namespace palpate::test
