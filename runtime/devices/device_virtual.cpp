// SPDX-License-Identifier: Apache-2.0
#include "runtime/devices/device_virtual.hpp"

#include <utility>

namespace palpate::runtime {

VirtualDevice::VirtualDevice(const SimulatedDeviceSettings& settings, double rate,
                             std::function<HandTarget(double)> hand)
    : device_(settings), period_(1 / rate), hand_(std::move(hand)) {}

void VirtualDevice::open() {
  time_ = 0;
  halted_ = false;
  open_ = true;
  device_.place(hand_(0).position, {});
}

void VirtualDevice::close() noexcept {
  open_ = false;
}

DeviceStatus VirtualDevice::read(DeviceReading& reading) noexcept {
  if (!open_) return DeviceStatus::Lost;
  reading.position = device_.position();
  reading.velocity = device_.velocity();
  return DeviceStatus::Good;
}

DeviceStatus VirtualDevice::command(const Vec3& force) noexcept {
  if (!open_) return DeviceStatus::Lost;
  const HandTarget target = hand_(time_);
  device_.set_target(target.position, target.velocity);
  device_.step(period_, halted_ ? Vec3{} : force);
  time_ += period_;
  return DeviceStatus::Good;
}

}  // namespace palpate::runtime
