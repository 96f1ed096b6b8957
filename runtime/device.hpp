// SPDX-License-Identifier: Apache-2.0
// The interface of a haptic device to the force loop.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include "format/vec3.hpp"

namespace palpate::runtime {

/// Result of a call in the loop.
enum class DeviceStatus : std::uint8_t {
  Good,
  Saturated,  ///< the device gives less force than commanded
  Late,       ///< no new sample in time: the last one again
  Lost        ///< unplugged, switched off, or its service ended: the loop ends
};

struct DeviceReading {
  Vec3 position{};            ///< m, tool tip, in the frame of the device
  Vec3 velocity{};            ///< m/s
  std::uint32_t buttons = 0;  ///< one bit each
};

/// A device with one point of three degrees of freedom. Call open() and close() outside the force
/// loop. One thread calls read() and command() alternately; they do not allocate in this library
/// and return a status instead of throwing. close() may be called at any time and repeatedly, and
/// leaves the device without force.
class Device {
 public:
  Device() = default;
  virtual ~Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  virtual std::string name() const = 0;
  /// @throws Error(Configuration) saying what is missing and what to do.
  virtual void open() = 0;
  virtual void close() noexcept = 0;

  virtual DeviceStatus read(DeviceReading& reading) noexcept = 0;
  /// Force on the tool, N, constant until the next command.
  virtual DeviceStatus command(const Vec3& force) noexcept = 0;
  /// No force from now on, whatever is commanded. For the watchdog; from any thread.
  virtual void halt() noexcept = 0;

  /// Largest force in any direction, N; NaN when not known.
  virtual double peak_force() const noexcept { return std::numeric_limits<double>::quiet_NaN(); }

  /// True for a driver that calls the loop from its own thread: after start_calls it calls `step`
  /// at its rate until `step` returns false or stop_calls() returns.
  virtual bool has_own_thread() const noexcept { return false; }
  virtual void start_calls(std::function<bool()> step);  ///< @throws Error when the driver refuses
  virtual void stop_calls() noexcept {}
};

}  // namespace palpate::runtime
