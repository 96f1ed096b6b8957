// SPDX-License-Identifier: Apache-2.0
// Force Dimension devices (omega, delta, sigma, lambda) and the Novint Falcon, through the DHD
// library of the vendor, bound at run time.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "runtime/device.hpp"

namespace palpate::runtime {

struct ForceDimensionSettings {
  std::string library;  ///< path of libdhd; empty: libdhd.so.3 on the search path of the system
  int id = -1;          ///< -1: the default device
};

/// Units of the vendor are SI. The watchdog of the device is set to 20 ms where the device supports
/// it. Motors are enabled with the first nonzero force.
class ForceDimensionDevice : public Device {
 public:
  explicit ForceDimensionDevice(ForceDimensionSettings settings);
  ~ForceDimensionDevice() override;

  std::string name() const override { return name_; }
  void open() override;
  void close() noexcept override;
  DeviceStatus read(DeviceReading& reading) noexcept override;
  DeviceStatus command(const Vec3& force) noexcept override;
  void halt() noexcept override;

 private:
  struct Driver;
  [[noreturn]] void fail(const std::string& what) const;

  ForceDimensionSettings settings_;
  std::string name_ = "Force Dimension";
  std::unique_ptr<Driver> driver_;
  char id_ = -1;
  bool open_ = false;
  bool forces_enabled_ = false;
  std::atomic<bool> halted_{false};
};

}  // namespace palpate::runtime
