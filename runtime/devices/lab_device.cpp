// SPDX-License-Identifier: Apache-2.0
#include "runtime/devices/lab_device.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "format/error.hpp"
#include "runtime/realtime.hpp"
#include "runtime/settings_check.hpp"

namespace palpate::runtime {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

bool above_zero(double value) {
  return std::isfinite(value) && value > 0;
}

void check(const LabAxis& axis, std::size_t j) {
  const SettingsCheck require("lab-built device, axis " + std::to_string(j));
  const char* positive = "a finite value above 0";
  require(above_zero(axis.counts_per_turn), "counts_per_turn", axis.counts_per_turn, positive);
  require(axis.counter_bits >= 8 && axis.counter_bits <= 32, "counter_bits", axis.counter_bits,
          "8 to 32");
  require(std::abs(axis.sign) == 1, "sign", axis.sign, "1 or -1");
  require(std::isfinite(axis.offset), "offset", axis.offset, "a finite value");
  require(above_zero(axis.gear), "gear", axis.gear, positive);
  require(above_zero(axis.torque_constant), "torque_constant", axis.torque_constant, positive);
  require(std::abs(axis.motor_sign) == 1, "motor_sign", axis.motor_sign, "1 or -1");
  require(above_zero(axis.current_limit), "current_limit", axis.current_limit, positive);
}

/// The shorter difference between two raw counts of a counter of `bits` that wraps around.
std::int64_t short_way(std::int32_t from, std::int32_t to, int bits) noexcept {
  const int spare = 32 - bits;
  const auto difference = static_cast<std::uint32_t>(to) - static_cast<std::uint32_t>(from);
  return static_cast<std::int32_t>(difference << spare) >> spare;
}

}  // namespace

LabDevice::LabDevice(LabDeviceSettings settings, SerialChain chain,
                     std::unique_ptr<LabElectronics> electronics)
    : settings_(std::move(settings)),
      chain_(std::move(chain)),
      electronics_(std::move(electronics)) {
  if (settings_.axes.size() != chain_.size()) {
    throw Error(ErrorKind::Configuration, settings_.name,
                std::to_string(settings_.axes.size()) + " axes for " +
                    std::to_string(chain_.size()) + " joints",
                "describe each joint once");
  }
  for (std::size_t j = 0; j < settings_.axes.size(); ++j) check(settings_.axes[j], j);
  const SettingsCheck require("lab-built device");
  require(above_zero(settings_.velocity_cutoff), "velocity_cutoff (Hz)", settings_.velocity_cutoff,
          "a finite value above 0");
}

LabDevice::~LabDevice() {
  close();
}

void LabDevice::open() {
  electronics_->open();
  open_ = true;
  halted_ = false;
  last_time_ = 0;
  total_count_ = {};
  last_count_ = {};
}

void LabDevice::close() noexcept {
  if (!open_) return;
  const std::array<double, kMost> none{};
  electronics_->write_current({none.data(), chain_.size()});
  electronics_->close();
  open_ = false;
}

void LabDevice::follow(std::size_t j, std::int32_t count) noexcept {
  const LabAxis& axis = settings_.axes[j];
  total_count_[j] += short_way(last_count_[j], count, axis.counter_bits);
  last_count_[j] = count;
  const double turns = static_cast<double>(total_count_[j]) / (axis.counts_per_turn * axis.gear);
  const double unit = chain_.kind(j) == JointKind::Revolute ? kTurn : 1;
  q_[j] = axis.offset + axis.sign * unit * turns;
}

DeviceStatus LabDevice::read(DeviceReading& reading) noexcept {
  if (!open_) return DeviceStatus::Lost;
  std::array<std::int32_t, kMost> counts{};
  if (!electronics_->read_counts({counts.data(), chain_.size()})) return DeviceStatus::Lost;
  for (std::size_t j = 0; j < chain_.size(); ++j) follow(j, counts[j]);
  pose_ = chain_.at(q_);
  filter_velocity(pose_.tip);
  reading.position = pose_.tip;
  reading.velocity = velocity_;
  return DeviceStatus::Good;
}

void LabDevice::filter_velocity(const Vec3& position) noexcept {
  const std::int64_t now = monotonic_ns();
  const double dt = 1e-9 * static_cast<double>(now - last_time_);
  if (last_time_ == 0) {
    velocity_ = {};
  } else if (dt > 0) {
    const double share = -std::expm1(-kTurn * settings_.velocity_cutoff * dt);
    const Vec3 raw = (1 / dt) * (position - last_position_);
    velocity_ = velocity_ + share * (raw - velocity_);
  }
  last_position_ = position;
  last_time_ = now;
}

DeviceStatus LabDevice::command(const Vec3& force) noexcept {
  if (!open_) return DeviceStatus::Lost;
  const Vec3 given = halted_ ? Vec3{} : force;
  std::array<double, kMost> current{};
  double scale = 1;
  for (std::size_t j = 0; j < chain_.size(); ++j) {
    const LabAxis& axis = settings_.axes[j];
    const double torque = dot(pose_.column[j], given);
    current[j] = axis.motor_sign * torque / (axis.gear * axis.torque_constant);
    scale = std::min(scale, axis.current_limit / std::max(std::abs(current[j]), 1e-300));
  }
  for (double& i : current) i *= scale;
  if (!electronics_->write_current({current.data(), chain_.size()})) return DeviceStatus::Lost;
  return scale < 1 ? DeviceStatus::Saturated : DeviceStatus::Good;
}

}  // namespace palpate::runtime
