// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/run/force_clamp.hpp"

#include <limits>

namespace palpate::app {

ForceClamp force_clamp(const fitting::DeviceProfile& profile, std::optional<double> asked,
                       double of_the_driver) {
  ForceClamp clamp{std::numeric_limits<double>::infinity(), ""};
  const auto lower_to = [&clamp](double force, const char* origin) {
    if (force < clamp.max_force) clamp = {force, origin};  // an unknown force lowers nothing
  };
  if (asked) {
    lower_to(*asked, "--max-force");
  } else {
    lower_to(profile.continuous_force, "the continuous force of the profile");
  }
  lower_to(profile.peak_force, "the peak force of the profile");
  if (of_the_driver > 0) lower_to(of_the_driver, "the largest force that the driver states");
  return clamp;
}

}  // namespace palpate::app
