// SPDX-License-Identifier: Apache-2.0
// Haply Inverse3, through the Haply Inverse Service: JSON over a WebSocket to this machine.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

#include "runtime/device.hpp"
#include "runtime/devices/websocket.hpp"

namespace palpate::runtime {

struct HaplySettings {
  std::string host = "localhost";
  std::uint16_t port = 10001;
  std::string device_id;  ///< empty: the first Inverse3 of the inventory
  int timeout_ms = 5;     ///< longest wait of a step for a state; less than the watchdog limit
};

/// The service sends an inventory first, then exactly one state for each message: command() sends a
/// force, and the next read() waits for the state that answers it, up to the timeout. When the
/// state is late, read() repeats the last one (Late), and until it has come command() sends only
/// forces smaller than the last one sent, so that a silent service is told to let go. The device is
/// Saturated when the force that the service reports is less than nine tenths of the lesser of the
/// last two sent; which of them it answers is not documented. Sockets need system calls, so a loop
/// with this device is not free of them.
class HaplyDevice : public Device {
 public:
  explicit HaplyDevice(HaplySettings settings);
  ~HaplyDevice() override;

  std::string name() const override { return "Haply Inverse3"; }
  void open() override;
  void close() noexcept override;
  DeviceStatus read(DeviceReading& reading) noexcept override;
  DeviceStatus command(const Vec3& force) noexcept override;
  void halt() noexcept override;

 private:
  void find_device();
  bool send_force(const Vec3& force) noexcept;
  bool take_state(std::string_view text) noexcept;
  bool gives_less(const Vec3& given) const noexcept;

  HaplySettings settings_;
  WebSocket socket_;
  DeviceReading last_;
  Vec3 sent_{}, sent_before_{};  ///< N
  bool saturated_ = false;       ///< in the last state
  bool open_ = false;
  int awaited_ = 0;  ///< states that answer the forces sent and have not come
  std::atomic<bool> halted_{false};
};

}  // namespace palpate::runtime
