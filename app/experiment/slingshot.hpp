// SPDX-License-Identifier: AGPL-3.0-or-later
// The experiment of Mahvash & Hayward 2005, section VI-B, in simulation: a rubber band pulls a
// device into a virtual body, where it comes to rest or oscillates.
#pragma once

#include <vector>

#include "app/experiment/sling_device.hpp"

namespace palpate::app {

enum class VirtualBody {
  Wall,     ///< the flat wall (34)
  Cylinder  ///< the deformable cylinder (35): 504 triangles, radius 40 mm
};

struct SlingshotSetup {
  VirtualBody body = VirtualBody::Wall;
  double off_axis = 0;     ///< m, distance of the line of motion from the axis of the cylinder
  double friction = 0.3;   ///< mu on the cylinder
  double rate = 2000;      ///< Hz, of the force
  double search_rate = 0;  ///< Hz, of the search for triangles; 0 = in the force loop itself
  bool bounded = false;    ///< the runtime enforces the Lipschitz bound k on the cylinder
  bool real_time = false;  ///< paced by the clock, with the search in a thread of its own
  SlingDevice device{};
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
  long steps = 0;                ///< of the force loop
  long late = 0;                 ///< in real time: steps that began more than a period late
  std::vector<PhasePoint> path;  ///< every sample, when asked for
};

/// One shot at stiffness k (N/m). One sample of delay, zero-order hold, motion exact between
/// samples, confined to a line. Velocities are judged in windows of 0.5 s: decayed below 2 mm/s,
/// oscillating when the mean of five windows drifts by less than 2e-5 m/s, until 400 s. On the
/// cylinder a swing with 1.5 times the energy of the release ends there, not decayed: it would grow
/// until it passes through.
SlingshotOutcome sling(const SlingshotSetup& setup, double k, bool keep_path = false);

/// The stiffness at which the oscillation begins to last, to `tolerance` (N/m) between low and
/// high.
/// @throws Error(Internal) when it does not lie between them.
double passivity_margin(const SlingshotSetup& setup, double low, double high, double tolerance);

}  // namespace palpate::app
