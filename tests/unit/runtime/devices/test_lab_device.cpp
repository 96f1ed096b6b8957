// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/devices/lab_device.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <thread>

#include "format/error.hpp"
#include "tests/unit/runtime/devices/arm.hpp"

namespace palpate::test {
namespace {

using runtime::DeviceReading;
using runtime::DeviceStatus;
using runtime::LabAxis;
using runtime::LabDevice;

/// Electronics in memory.
class Bench : public runtime::LabElectronics {
 public:
  struct Wires {
    std::array<std::int32_t, 3> counts{};
    std::array<double, 3> current{};
  };
  explicit Bench(Wires& wires) : wires_(wires) {}
  void open() override {}
  void close() noexcept override {}
  bool read_counts(std::span<std::int32_t> counts) noexcept override {
    std::copy_n(wires_.counts.begin(), counts.size(), counts.begin());
    return true;
  }
  bool write_current(std::span<const double> current) noexcept override {
    std::copy_n(current.begin(), current.size(), wires_.current.begin());
    return true;
  }

 private:
  Wires& wires_;
};

LabAxis axis_of_arm() {
  LabAxis axis;
  axis.counts_per_turn = 4000;
  axis.counter_bits = 16;
  axis.gear = 10;
  axis.torque_constant = 0.05;
  axis.current_limit = 2;
  return axis;
}

std::unique_ptr<LabDevice> arm_on(Bench::Wires& wires, LabAxis first = axis_of_arm()) {
  return std::make_unique<LabDevice>(
      runtime::LabDeviceSettings{"arm", {first, axis_of_arm(), axis_of_arm()}, 80}, arm(),
      std::make_unique<Bench>(wires));
}

TEST(LabDevice, FollowsACounterThatWrapsAround) {
  // Two and a half turns of the turntable: 100 000 counts, past 16 bits, and back.
  Bench::Wires wires;
  LabAxis axis = axis_of_arm();
  axis.sign = -1;
  axis.offset = 0.3;
  const auto device = arm_on(wires, axis);
  device->open();
  DeviceReading reading;
  for (int i = 0; i <= 1000; ++i) {
    const int total = i <= 500 ? 200 * i : 200 * (1000 - i);
    wires.counts[0] = total & 0xFFFF;
    ASSERT_EQ(device->read(reading), DeviceStatus::Good);
    const double angle = 0.3 - 2 * std::numbers::pi * total / 40000;
    ASSERT_NEAR(reading.position[0], 0.35 * std::cos(angle), 1e-12);
    ASSERT_NEAR(reading.position[1], 0.35 * std::sin(angle), 1e-12);
  }
}

TEST(LabDevice, TheCurrentsDoTheWorkOfTheForce) {
  // Virtual work: sum of torque times joint velocity = force times tip velocity, whatever the pose.
  Bench::Wires wires;
  const auto device = arm_on(wires);
  device->open();
  DeviceReading reading;
  for (int trial = 0; trial < 20; ++trial) {
    const std::array<int, 3> at{700 * trial % 9000, 300 * trial % 4000, 500 * trial % 5000};
    const auto read_at = [&](std::size_t j, int more) {
      for (std::size_t k = 0; k < 3; ++k) {
        wires.counts[k] = at[k] + (k == j ? more : 0);
      }
      device->read(reading);
      return reading.position;
    };
    const Vec3 force{0.3, -0.2, 0.4};
    for (std::size_t j = 0; j < 3; ++j) {
      const Vec3 motion = read_at(j, 1) - read_at(j, -1);
      read_at(j, 0);
      EXPECT_EQ(device->command(force), DeviceStatus::Good);
      const double turned = 2 * 2 * std::numbers::pi / 40000;
      const double torque = wires.current[j] * 10 * 0.05;
      EXPECT_NEAR(torque * turned, dot(force, motion), 1e-9);
    }
  }
}

TEST(LabDevice, SaturatedItKeepsTheDirectionOfTheForce) {
  Bench::Wires wires;
  const auto device = arm_on(wires);
  device->open();
  DeviceReading reading;
  wires.counts = {1000, 2000, 3000};
  device->read(reading);
  EXPECT_EQ(device->command({0.5, 0.2, -0.1}), DeviceStatus::Good);
  const auto small = wires.current;
  EXPECT_EQ(device->command({50, 20, -10}), DeviceStatus::Saturated);
  double largest = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_NEAR(wires.current[j] * small[0], small[j] * wires.current[0], 1e-12);
    largest = std::max(largest, std::abs(wires.current[j]));
  }
  EXPECT_NEAR(largest, 2, 1e-12);
}

TEST(LabDevice, TheVelocityIsThatOfTheMotion) {
  // A slow turn; the clock is real, so it is measured beside.
  Bench::Wires wires;
  const auto device = arm_on(wires);
  device->open();
  DeviceReading reading;
  for (int i = 0; i < 100; ++i) {
    wires.counts[0] = 4 * i;
    device->read(reading);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_GT(norm(reading.velocity), 0.01);
  EXPECT_LT(norm(reading.velocity), 0.35 * 4 * 2 * std::numbers::pi / 40000 / 1e-3 * 1.01);
  for (int i = 0; i < 40; ++i) {
    device->read(reading);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_LT(norm(reading.velocity), 1e-6);
}

TEST(LabDevice, RefusesConstantsOutOfRange) {
  Bench::Wires wires;
  for (double LabAxis::*field : {&LabAxis::counts_per_turn, &LabAxis::sign, &LabAxis::gear,
                                 &LabAxis::torque_constant, &LabAxis::current_limit}) {
    LabAxis bad = axis_of_arm();
    bad.*field = 0;
    EXPECT_THROW(arm_on(wires, bad), Error);
  }
  LabAxis bits = axis_of_arm();
  bits.counter_bits = 40;
  EXPECT_THROW(arm_on(wires, bits), Error);
}

}  // namespace
}  // namespace palpate::test
