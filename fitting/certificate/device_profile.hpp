// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>

#include "format/numbers.hpp"

namespace palpate::fitting {

/// A haptic device as its documentation describes it.
struct DeviceProfile {
  std::string name;
  double damping = kUnknown;           ///< smallest viscous damping over directions, N s/m
  double coulomb_friction = kUnknown;  ///< N
  double peak_force = kUnknown;        ///< N
  std::string source;
};

}  // namespace palpate::fitting
