// SPDX-License-Identifier: AGPL-3.0-or-later
// Logs of a robot with a force sensor: positions and forces in three dimensions, placed on the
// body and split into a press along the press direction and a drag across it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fitting/measurement/records/drag.hpp"
#include "fitting/measurement/records/placement.hpp"
#include "fitting/measurement/records/press.hpp"

namespace palpate::measured {

/// One log in SI, in the frame of the body. `force` is of the tool on the body.
struct RobotLog {
  std::string name;
  std::vector<double> time;  ///< may be empty
  std::vector<Vec3> tip;     ///< reference point of the tool
  std::vector<Vec3> force;
  std::vector<Vec3> readings;  ///< N, of the channels of the force sensor; may be empty
};

struct RobotSettings {
  PressSettings press;
  double placement_tolerance = 0.005;  ///< m, from the first touch to the vertex of the site
  double centre_to_tip = 0;            ///< m, from the logged point to the tip, along the press
  int lateral_samples = 12;
};

/// What one log says about its site.
struct RobotCurves {
  NearestSite site;
  Vec3 touch{};                   ///< where the tip was at the contact point
  PressCurve press;               ///< normal parts
  double tilt = 0;                ///< rad, of the direction of the press against inward
  std::optional<DragCurve> drag;  ///< empty when the log has no drag at a constant depth
};

/// Find the site by the first touch, turn displacement and force into their parts along inward and
/// across it, and sort out press and drag. A drag begins where the tip leaves the line of the press
/// sideways at a depth that stays within a tenth; it ends where the tool slips (cut_at_slip), for a
/// lateral path has no slip.
/// @throws Error(Configuration) as analyse_press and nearest_site; for a press tilted by more than
///   30 degrees, a force that points out of the body.
RobotCurves analyse_robot_log(const RobotLog& log, const Body& body, const RobotSettings& settings);

}  // namespace palpate::measured
