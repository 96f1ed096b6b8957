// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include "app/case/case.hpp"
#include "runtime/devices/device_simulated.hpp"

namespace palpate::app {

/// The device and the hand of a script.
inline runtime::SimulatedDeviceSettings simulated_device(const SimulateSection& script) {
  runtime::SimulatedDeviceSettings settings;
  settings.mass = script.mass;
  settings.damping = script.damping;
  settings.coulomb_friction = script.coulomb_friction;
  settings.hand_stiffness = script.hand_stiffness;
  settings.hand_damping = script.hand_damping;
  return settings;
}

}  // namespace palpate::app
