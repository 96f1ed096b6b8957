// SPDX-License-Identifier: AGPL-3.0-or-later
// The margins of the experiment from the energy balance of a swing: a check of the simulation that
// simulates no device.
#pragma once

#include "app/experiment/slingshot.hpp"

namespace palpate::app {

/// For a fixed contact point and a line at `angle` (rad) to its normal: the k at
/// which the largest value over all amplitudes of the integral of (1.5 T W''(x) - b) v^2 - S |v| dt
/// is zero, T the period and W the energy of the responses (35), normal and lateral. In closed form
/// but for the integral. At angle 0 it is the wall (34).
double bonded_margin_by_energy_balance(const SlingDevice& device, double rate, double angle);

/// For any body, with friction: each swing of the mass between body and band, from the quasi-static
/// force, is played to the force loop at its rate. Its gain is the work of the sampled and delayed
/// forces minus the dissipation by damping and dry friction. @return the k at which the largest
/// gain is zero, to 0.5 N/m, to first order in the gain: the swing is computed without it.
double margin_by_played_swings(const SlingshotSetup& setup);

}  // namespace palpate::app
