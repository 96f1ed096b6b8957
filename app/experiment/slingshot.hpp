// SPDX-License-Identifier: AGPL-3.0-or-later
// The experiment of Mahvash & Hayward 2005, section VI-B, in simulation: a rubber band pulls a
// device into a virtual body, where it comes to rest or oscillates.
#pragma once

#include <vector>

namespace palpate::app {

enum class VirtualBody {
  Wall,     ///< the flat wall (34)
  Cylinder  ///< the deformable cylinder (35): about 500 patches of 10 mm, radius 40 mm
};

struct SlingshotSetup {
  VirtualBody body = VirtualBody::Wall;
  double off_axis = 0;     ///< m, distance of the line of motion from the axis of the cylinder
  double friction = 0.3;   ///< mu on the cylinder
  double rate = 2000;      ///< Hz, of the force
  double search_rate = 0;  ///< Hz, of the search for triangles; 0 = in the force loop itself
};

struct PhasePoint {
  double position = 0;  ///< m, into the body
  double velocity = 0;  ///< m/s
};

struct SlingshotOutcome {
  bool decayed = false;          ///< came to rest; else it oscillates
  double amplitude = 0;          ///< m/s, half of the peak-to-peak velocity at the end
  double impact = 0;             ///< m/s, velocity at the first touch
  double seconds = 0;            ///< simulated
  std::vector<PhasePoint> path;  ///< every sample, when asked for
};

/// One shot at stiffness k (N/m). The device has 0.0845 kg, 0.081 N s/m and 0.01 N of dry friction,
/// the band 20 N/m anchored 58.4 mm inside: values that reproduce the published margin;
/// those of the paper's device are not published. One sample of delay, zero-order hold, motion
/// exact between samples, confined to a line. Velocities are judged in windows of 0.5 s: decayed
/// below 2 mm/s, oscillating when the mean of five windows drifts by less than 2e-5 m/s, until 400
/// s.
SlingshotOutcome sling(const SlingshotSetup& setup, double k, bool keep_path = false);

/// The stiffness at which the oscillation begins to last, to `tolerance` (N/m) between low and
/// high.
/// @throws Error(Internal) when it does not lie between them.
double passivity_margin(const SlingshotSetup& setup, double low, double high, double tolerance);

}  // namespace palpate::app
