// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>

#include "format/numbers.hpp"
#include "format/passivity.hpp"

namespace palpate::fitting {

/// A haptic device as its documentation describes it.
struct DeviceProfile {
  std::string name;
  double damping = kUnknown;           ///< smallest viscous damping over directions, N s/m
  double coulomb_friction = kUnknown;  ///< N
  double peak_force = kUnknown;        ///< N
  std::string source;
  double delay = kUnknown;  ///< s, from the position to the force, beyond that of the loop
  double position_resolution = kUnknown;  ///< m, step of the reported position along an axis
  double force_resolution = kUnknown;     ///< N, step of the force along an axis
  double continuous_force = kUnknown;     ///< N, sustained without a limit of time

  DeviceConstants constants() const {
    return {damping, coulomb_friction, delay, position_resolution, force_resolution};
  }
};

}  // namespace palpate::fitting
