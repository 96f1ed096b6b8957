// SPDX-License-Identifier: Apache-2.0
// 3D Systems Touch, Touch X and Phantom, through the HDAPI of OpenHaptics, bound at run time.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "runtime/device.hpp"

namespace palpate::runtime {

struct OpenHapticsSettings {
  std::string library;  ///< path of libHD; empty: libHD.so on the search path of the system
  std::string device;   ///< name given in the vendor's setup; empty: the default device
};

/// The vendor owns the servo thread: the force loop is called from it (has_own_thread), read()
/// begins its frame and command() ends it. Units of the vendor are mm and N; here SI.
class OpenHapticsDevice : public Device {
 public:
  explicit OpenHapticsDevice(OpenHapticsSettings settings);
  ~OpenHapticsDevice() override;

  std::string name() const override { return "OpenHaptics"; }
  void open() override;
  void close() noexcept override;
  DeviceStatus read(DeviceReading& reading) noexcept override;
  DeviceStatus command(const Vec3& force) noexcept override;
  void halt() noexcept override;
  double peak_force() const noexcept override { return peak_force_; }

  bool has_own_thread() const noexcept override { return true; }
  void start_calls(std::function<bool()> step) override;
  void stop_calls() noexcept override;

 private:
  struct Driver;
  static unsigned servo_tick(void* self);
  DeviceStatus drain_errors() noexcept;
  [[noreturn]] static void fail(const std::string& what, unsigned code);

  OpenHapticsSettings settings_;
  std::unique_ptr<Driver> driver_;
  unsigned handle_ = 0;
  unsigned long schedule_ = 0;
  bool open_ = false, calling_ = false, in_frame_ = false;
  double peak_force_ = std::numeric_limits<double>::quiet_NaN();
  std::function<bool()> step_;
  std::atomic<bool> halted_{false};
};

}  // namespace palpate::runtime
