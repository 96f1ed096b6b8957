// SPDX-License-Identifier: AGPL-3.0-or-later
// A device profile from the estimates of its axes, on the safe side.
#pragma once

#include <string>
#include <vector>

#include "fitting/certificate/device_profile.hpp"
#include "fitting/measurement/identify/estimate.hpp"
#include "format/vec3.hpp"

namespace palpate::app {

/// What was found along one direction, in the frame whose first axis it is.
struct DirectionFinding {
  Vec3 direction{};  ///< unit vector
  identify::AxisEstimate estimate;
  double position_step = kUnknown;  ///< m
  double longer = 0;                ///< s, longest period of the loop less the nominal one
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

/// Damping: the smallest eigenvalue of the matrix that fits the directions, less two and a half
/// deviations. Dry friction: the smallest lower bound over all directions, at least zero. Delay:
/// the largest of a sample and what lengthens the period, whole: which part of it is a sample of
/// the loop, and shrinks at a higher rate, does not show. Resolution: the largest of the
/// directions. A constant is missing where a direction has a problem, damping where it is not above
/// zero, and delay where its spread is not known.
DeviceFindings combine(const std::vector<DirectionFinding>& directions);

/// What was found along a direction, in words.
std::string direction_line(const DirectionFinding& found);

/// The file of a device profile (TOML), each constant with what it was derived from.
std::string profile_text(const DeviceFindings& findings,
                         const std::vector<DirectionFinding>& directions);

}  // namespace palpate::app
