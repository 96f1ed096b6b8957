// SPDX-License-Identifier: AGPL-3.0-or-later
// The options that name a device, for every command that opens one.
#pragma once

#include "app/run/device_choice.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): a name of the library
class App;
}

namespace palpate::app {

void add_device_choice(CLI::App& command, DeviceChoice& choice);

/// Prints the devices, for --list. @return the exit code
int list_devices();

}  // namespace palpate::app
