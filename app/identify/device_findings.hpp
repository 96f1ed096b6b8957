// SPDX-License-Identifier: AGPL-3.0-or-later
// A device profile from the estimates of its axes, on the safe side.
#pragma once

#include <string>
#include <vector>

#include "fitting/certificate/device_profile.hpp"
#include "fitting/measurement/identify/estimate.hpp"

namespace palpate::app {

/// What was found along one axis.
struct AxisFinding {
  std::size_t axis = 0;
  identify::AxisEstimate estimate;
  double position_step = kUnknown;  ///< m
};

/// A constant that the profile lacks.
struct Missing {
  std::string constant, reason;
};

struct DeviceFindings {
  fitting::DeviceProfile profile;  ///< without name, source and forces
  double damping = kUnknown;       ///< N s/m, best estimate of sigma_0(B), not its lower bound
  std::vector<Missing> missing;
};

/// Damping: the smallest eigenvalue of the symmetric part of B, which is assembled from the rows of
/// the axes, less two and a half deviations. Dry friction: the smallest lower bound of the axes, at
/// least zero. Delay: the largest upper bound, whole: which part of it is a sample of the loop, and
/// shrinks at a higher rate, does not show. Resolution: the largest of the axes. A constant is
/// missing where an axis has a problem, and damping where it is not above zero.
DeviceFindings combine(const std::vector<AxisFinding>& axes);

/// "x", "y" or "z"
std::string axis_name(std::size_t axis);

/// The file of a device profile (TOML), each constant with what it was derived from.
std::string profile_text(const DeviceFindings& findings, const std::vector<AxisFinding>& axes);

}  // namespace palpate::app
