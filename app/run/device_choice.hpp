// SPDX-License-Identifier: AGPL-3.0-or-later
// Makes a device from its name.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "runtime/device.hpp"
#include "runtime/devices/device_virtual.hpp"

namespace palpate::app {

struct DeviceChoice {
  std::string name;      ///< one of device_names()
  std::string driver;    ///< path of the vendor's library; empty: on the search path of the system
  std::string unit;      ///< which one of several: number, name or identity; empty: the default
  std::string lab_file;  ///< configuration of a lab-built device
  std::string host = "localhost";  ///< of the Haply service
  std::uint16_t port = 10001;
  double rate = 1000;  ///< Hz, of the simulated device
};

/// The published device with a hand, simulated.
inline constexpr const char* kSimulatedDevice = "simulated";

struct DeviceName {
  std::string name, about;
};
const std::vector<DeviceName>& device_names();

/// @throws Error(Configuration) for a name that is not among them; the remedy is the device whose
/// description contains it, or else the nearest name.
void require_known_device(const std::string& name);

/// Not opened yet. `hand`: of the simulated device. @throws Error(Configuration) for an unknown
/// name or an invalid configuration.
std::unique_ptr<runtime::Device> make_device(
    const DeviceChoice& choice, const std::function<runtime::HandTarget(double)>& hand);

/// The lab-built device of a TOML file; see docs/devices.md. @throws Error(Configuration).
std::unique_ptr<runtime::Device> read_lab_device(const std::string& file,
                                                 const std::string& driver);

}  // namespace palpate::app
