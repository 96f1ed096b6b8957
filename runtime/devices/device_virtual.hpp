// SPDX-License-Identifier: Apache-2.0
// The simulated device with the interface of real devices.
#pragma once

#include <atomic>
#include <functional>

#include "runtime/device.hpp"
#include "runtime/devices/device_simulated.hpp"

namespace palpate::runtime {

/// Target of the hand at a time since open(), and its velocity.
struct HandTarget {
  Vec3 position{};  ///< m
  Vec3 velocity{};  ///< m/s
};

/// Each command advances the simulated device by exactly one period, whatever the clock says, so
/// that sessions are reproducible.
class VirtualDevice : public Device {
 public:
  /// rate: commands per second, Hz. hand: called once a step, in the force loop.
  VirtualDevice(const SimulatedDeviceSettings& settings, double rate,
                std::function<HandTarget(double time)> hand);

  std::string name() const override { return "simulated"; }
  void open() override;
  void close() noexcept override;
  DeviceStatus read(DeviceReading& reading) noexcept override;
  DeviceStatus command(const Vec3& force) noexcept override;
  void halt() noexcept override { halted_ = true; }

 private:
  SimulatedDevice device_;
  double period_;  ///< s
  std::function<HandTarget(double)> hand_;
  double time_ = 0;  ///< s
  bool open_ = false;
  std::atomic<bool> halted_{false};
};

}  // namespace palpate::runtime
