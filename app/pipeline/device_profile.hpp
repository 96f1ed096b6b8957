// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>

#include "fitting/certificate/device_profile.hpp"

namespace palpate::app {

/// Reads the profile of a haptic device (TOML; see data/devices). A missing quantity is unknown and
/// becomes NaN. @throws Error(Configuration).
fitting::DeviceProfile read_device_profile(const std::filesystem::path& path);

}  // namespace palpate::app
