// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/run/device_choice.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <string_view>

#include "app/case/case.hpp"
#include "app/case/nearest.hpp"
#include "format/error.hpp"
#include "runtime/devices/force_dimension.hpp"
#include "runtime/devices/haply.hpp"
#include "runtime/devices/open_haptics.hpp"
#include "runtime/safety.hpp"

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
  return std::make_unique<runtime::VirtualDevice>(kPublishedDevice, choice.rate, hand);
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// A product or maker where the name of a binding is asked for: "Falcon", "omega".
const DeviceName* named_in_a_description(const std::string& word) {
  constexpr std::size_t kShortest = 4;  // "no" is in "Novint"
  if (word.size() < kShortest) return nullptr;
  for (const DeviceName& device : device_names())
    if (lower_case(device.about).find(lower_case(word)) != std::string::npos) return &device;
  return nullptr;
}

std::string instead_of(const std::string& name) {
  std::vector<std::string_view> known;
  for (const DeviceName& device : device_names()) known.push_back(device.name);
  return meant_instead(name, known, "the nearest");
}

}  // namespace

const std::vector<DeviceName>& device_names() {
  static const std::vector<DeviceName> names{
      {kSimulatedDevice, "a simulated device with a hand"},
      {"force-dimension", "omega, delta, sigma, lambda and the Novint Falcon (libdhd)"},
      {"openhaptics", "3D Systems Touch and Phantom, once Sensable (libHD)"},
      {"haply", "Haply Inverse3, through its Inverse Service"},
      {"lab", "a lab-built device on a Comedi board, described by --lab FILE"}};
  return names;
}

void require_known_device(const std::string& name) {
  for (const DeviceName& device : device_names())
    if (device.name == name) return;
  const DeviceName* named = named_in_a_description(name);
  throw Error(ErrorKind::Configuration, "--device", "'" + name + "' is not known",
              named != nullptr ? "it is one of '" + named->name + "': " + named->about
                               : instead_of(name) + "; see palpate run --list");
}

std::unique_ptr<runtime::Device> make_device(
    const DeviceChoice& choice, const std::function<runtime::HandTarget(double)>& hand) {
  require_known_device(choice.name);
  if (choice.name == kSimulatedDevice) return simulated(choice, hand);
  if (choice.name == "force-dimension") {
    return std::make_unique<runtime::ForceDimensionDevice>(
        runtime::ForceDimensionSettings{choice.driver, unit_number(choice.unit)});
  }
  if (choice.name == "openhaptics") {
    return std::make_unique<runtime::OpenHapticsDevice>(
        runtime::OpenHapticsSettings{choice.driver, choice.unit});
  }
  if (choice.name == "haply") {
    // A wait for a state must not look like a stall of the loop.
    const double patience = 1e3 * runtime::default_watchdog(choice.rate) / 4;  // ms
    return std::make_unique<runtime::HaplyDevice>(runtime::HaplySettings{
        choice.host, choice.port, choice.unit, static_cast<int>(std::clamp(patience, 1.0, 5.0))});
  }
  return read_lab_device(choice.lab_file, choice.driver);
}

}  // namespace palpate::app
