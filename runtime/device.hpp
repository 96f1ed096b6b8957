// SPDX-License-Identifier: Apache-2.0
// What the force loop asks of a haptic device.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include "format/vec3.hpp"

namespace palpate::runtime {

/// How a call in the loop went.
enum class DeviceStatus : std::uint8_t {
  Good,
  Saturated,  ///< the device gives less force than it was asked for
  Late,       ///< no new sample in time: the last one again
  Lost        ///< unplugged, switched off, or its service is gone: no further call makes sense
};

struct DeviceReading {
  Vec3 position{};            ///< m, tool tip, in the frame of the device
  Vec3 velocity{};            ///< m/s
  std::uint32_t buttons = 0;  ///< one bit each
};

/// A device with one point of three degrees of freedom. open() and close() belong outside the force
/// loop; read() and command() are called by one thread, alternately, never allocate in this
/// library, and return a status instead of throwing. close() is safe to call at any time and twice,
/// and leaves the device without force.
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
  /// Force on the tool, N, held until the next command.
  virtual DeviceStatus command(const Vec3& force) noexcept = 0;
  /// No force from now on, whatever is commanded. For the watchdog: from any thread.
  virtual void halt() noexcept = 0;

  /// Largest force it can give in any direction, N; NaN when it does not say.
  virtual double peak_force() const noexcept { return std::numeric_limits<double>::quiet_NaN(); }

  /// A driver that calls the loop from its own thread returns true and takes the loop by
  /// start_calls: `step` is called at the rate of the driver until it returns false or stop_calls()
  /// returns.
  virtual bool has_own_thread() const noexcept { return false; }
  virtual void start_calls(std::function<bool()> step);  ///< @throws Error when the driver refuses
  virtual void stop_calls() noexcept {}
};

}  // namespace palpate::runtime
