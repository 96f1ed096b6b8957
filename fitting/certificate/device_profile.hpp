// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <limits>
#include <string>

namespace palpate::fitting {

/// A value that a device profile or a setting does not state.
inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A haptic device as its documentation describes it.
struct DeviceProfile {
  std::string name;
  double damping = kUnknown;           ///< smallest viscous damping over directions, N s/m
  double coulomb_friction = kUnknown;  ///< N
  double peak_force = kUnknown;        ///< N
  std::string source;
};

}  // namespace palpate::fitting
