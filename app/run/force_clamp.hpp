// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "fitting/certificate/device_profile.hpp"

namespace palpate::app {

/// The largest force that a session commands, and where it comes from.
struct ForceClamp {
  double max_force = 0;  ///< N; infinite: none
  std::string origin;    ///< in words; empty: none
};

/// What the user asks for (N), or else the continuous force of the profile, or else its peak force,
/// or else what the driver states (N; NaN: nothing). Never above the peak force of profile or
/// driver.
ForceClamp force_clamp(const fitting::DeviceProfile& profile, std::optional<double> asked,
                       double of_the_driver);

}  // namespace palpate::app
