// SPDX-License-Identifier: AGPL-3.0-or-later
// The parts that the bindings are made of.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <thread>

#include "format/error.hpp"
#include "runtime/devices/haply.hpp"
#include "runtime/devices/json_view.hpp"
#include "runtime/devices/lab_device.hpp"
#include "runtime/devices/serial_chain.hpp"
#include "runtime/devices/websocket.hpp"
#include "tests/unit/runtime/devices/fake_haply.hpp"

namespace palpate::test {
namespace {

using runtime::DeviceReading;
using runtime::DeviceStatus;
using runtime::Joint;
using runtime::JointKind;
using runtime::JsonView;
using runtime::LabAxis;
using runtime::LabDevice;
using runtime::SerialChain;

TEST(JsonView, FindsValuesInNestedText) {
  const JsonView json(R"( {"a": [1, {"b": "x]}\"y", "c": -2.5e-3}], "d": true, "e": {}} )");
  double value = 0;
  ASSERT_TRUE(json["a"][1]["c"].number(value));
  EXPECT_EQ(value, -2.5e-3);
  EXPECT_EQ(json["a"][1]["b"].string(), R"(x]}\"y)");
  EXPECT_TRUE(json["a"][0].number(value));
  EXPECT_EQ(value, 1);
  EXPECT_FALSE(json["a"][2]);
  EXPECT_FALSE(json["f"]);
  EXPECT_FALSE(json["e"]["f"]);
  EXPECT_FALSE(json["d"].number(value));
  EXPECT_EQ(value, 1);  // untouched
}

TEST(JsonView, SurvivesWhatIsNoJson) {
  const std::string whole = R"({"inverse3":[{"device_id":"049D","state":{"x":{"y":[1,2,3]}}}]})";
  for (std::size_t cut = 0; cut < whole.size(); ++cut) {
    const JsonView json(std::string_view(whole).substr(0, cut));
    EXPECT_FALSE(json["inverse3"][0]["state"]["x"]["y"][2]) << cut;
  }
  EXPECT_FALSE(JsonView(std::string(100000, '[')));
  std::mt19937 random(3);
  for (int i = 0; i < 20000; ++i) {  // any damage: an answer or none, never a crash
    std::string damaged = whole;
    for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
    double value = 0;
    JsonView(damaged)["inverse3"][0]["state"]["x"]["y"][1].number(value);
  }
}

TEST(WebSocket, AcceptsAsTheStandardSays) {
  EXPECT_EQ(runtime::websocket_accept("dGhlIHNhbXBsZSBub25jZQ=="),
            "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");  // RFC 6455, 1.3
}

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

/// Two links of 0.2 m and 0.15 m in the plane, on a turntable.
SerialChain arm() {
  return SerialChain({{JointKind::Turns, {0, 0, 1}, {0, 0, 0}},
                      {JointKind::Turns, {0, 1, 0}, {0, 0, 0.1}},
                      {JointKind::Turns, {0, 1, 0}, {0.2, 0, 0.1}}},
                     {0.35, 0, 0.1});
}

TEST(SerialChain, FollowsTheTrigonometryOfTheArm) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-2, 2);
  for (int i = 0; i < 200; ++i) {
    const double a = any(random), b = any(random), c = any(random);
    const double reach = 0.2 * std::cos(b) + 0.15 * std::cos(b + c);
    const double height = 0.1 - 0.2 * std::sin(b) - 0.15 * std::sin(b + c);
    const auto pose = arm().at({a, b, c});
    EXPECT_NEAR(norm(pose.tip - Vec3{reach * std::cos(a), reach * std::sin(a), height}), 0, 1e-14);
  }
}

TEST(SerialChain, TheColumnsAreTheDerivativesOfTheTip) {
  SerialChain chain({{JointKind::Turns, {0, 0, 1}, {0.01, 0.02, 0}},
                     {JointKind::Slides, {0.6, 0, 0.8}, {}},
                     {JointKind::Turns, {0, 0.6, 0.8}, {0.1, 0, 0.1}}},
                    {0.2, 0.1, 0.3});
  const std::array<double, 6> q{0.4, 0.03, -1.1};
  const auto pose = chain.at(q);
  for (std::size_t j = 0; j < 3; ++j) {
    auto more = q;
    auto less = q;
    more[j] += 1e-6;
    less[j] -= 1e-6;
    const Vec3 slope = 5e5 * (chain.at(more).tip - chain.at(less).tip);
    EXPECT_NEAR(norm(slope - pose.column[j]), 0, 1e-9) << j;
  }
}

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
  EXPECT_THROW(SerialChain({{JointKind::Turns, {0, 0, 2}, {}}}, {}), Error);
  EXPECT_THROW(SerialChain({}, {}), Error);
}

}  // namespace
}  // namespace palpate::test
