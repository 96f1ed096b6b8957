// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/run/device_choice.hpp"

#include <charconv>
#include <string_view>

#include "app/case/nearest.hpp"
#include "app/simulate/simulated_device.hpp"
#include "format/error.hpp"
#include "runtime/devices/force_dimension.hpp"
#include "runtime/devices/haply.hpp"
#include "runtime/devices/open_haptics.hpp"

namespace palpate::app {
namespace {

int unit_number(const std::string& unit) {
  if (unit.empty()) return -1;
  int number = -1;
  const auto [end, error] = std::from_chars(unit.data(), unit.data() + unit.size(), number);
  if (error == std::errc() && end == unit.data() + unit.size() && number >= 0) return number;
  throw Error(ErrorKind::Configuration, "--unit", "'" + unit + "' is no number",
              "Force Dimension devices are numbered from 0");
}

std::unique_ptr<runtime::Device> simulated(const DeviceChoice& choice,
                                           const std::function<runtime::HandTarget(double)>& hand) {
  return std::make_unique<runtime::VirtualDevice>(simulated_device({}), choice.rate, hand);
}

}  // namespace

const std::vector<DeviceName>& device_names() {
  static const std::vector<DeviceName> names{
      {"simulated", "a device and a hand in place of hardware"},
      {"force-dimension", "omega, delta, sigma, lambda and the Novint Falcon (libdhd)"},
      {"openhaptics", "3D Systems Touch and Phantom (libHD)"},
      {"haply", "Haply Inverse3, through its Inverse Service"},
      {"lab", "a lab-built device on a Comedi board, described by --lab FILE"}};
  return names;
}

void require_known_device(const std::string& name) {
  std::vector<std::string_view> known;
  for (const DeviceName& device : device_names()) {
    if (device.name == name) return;
    known.push_back(device.name);
  }
  throw Error(ErrorKind::Configuration, "--device", "'" + name + "' is not known",
              "the nearest is '" + std::string(nearest(name, known)) + "'; see palpate run --list");
}

std::unique_ptr<runtime::Device> make_device(
    const DeviceChoice& choice, const std::function<runtime::HandTarget(double)>& hand) {
  require_known_device(choice.name);
  if (choice.name == "simulated") return simulated(choice, hand);
  if (choice.name == "force-dimension") {
    return std::make_unique<runtime::ForceDimensionDevice>(
        runtime::ForceDimensionSettings{choice.driver, unit_number(choice.unit)});
  }
  if (choice.name == "openhaptics") {
    return std::make_unique<runtime::OpenHapticsDevice>(
        runtime::OpenHapticsSettings{choice.driver, choice.unit});
  }
  if (choice.name == "haply") {
    return std::make_unique<runtime::HaplyDevice>(
        runtime::HaplySettings{choice.host, choice.port, choice.unit});
  }
  return read_lab_device(choice.lab_file, choice.driver);
}

}  // namespace palpate::app
