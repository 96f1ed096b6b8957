// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/run/device_options.hpp"

#include <CLI/CLI.hpp>

#include "app/command.hpp"
#include "app/console.hpp"

namespace palpate::app {

int list_devices() {
  answer("devices:");
  for (const DeviceName& device : device_names()) answer("  {:<16} {}", device.name, device.about);
  return kExitDone;
}

void add_device_choice(CLI::App& command, DeviceChoice& choice) {
  command.add_option("--device", choice.name, "Device; see --list")->default_val(kSimulatedDevice);
  command.add_option("--driver", choice.driver, "Path of the vendor library, if not installed");
  command.add_option("--unit", choice.unit,
                     "Which of several devices: number, name or serial number");
  command.add_option("--lab", choice.lab_file, "Configuration of a lab-built device (TOML)");
  command.add_option("--host", choice.host,
                     "Address of the Haply Inverse Service (default: localhost)");
  command.add_option("--port", choice.port, "Port of the Haply Inverse Service (default: 10001)");
}

}  // namespace palpate::app
