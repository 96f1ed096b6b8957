// SPDX-License-Identifier: AGPL-3.0-or-later
// The margins of the experiment from the balance of energy over a swing: no simulation of the
// device, hence a check of it.
#pragma once

#include "app/experiment/slingshot.hpp"

namespace palpate::app {

/// Where the contact point is held, and the line is at `angle` (rad) to the normal there: the k at
/// which the largest value over all amplitudes of the integral of (1.5 T W''(x) - b) v^2 - S |v| dt
/// is zero, T the period and W the energy of the responses (35), normal and lateral. In closed form
/// but for the integral. At angle 0 it is the wall (34).
double bonded_margin_by_energy_balance(double rate, double angle);

/// Of any body, where friction and the path matter: each swing of the mass between body and band,
/// felt slowly, is played to the force loop at its rate; what the held and late forces of that
/// motion do, less what damping and dry friction take, is its gain. The k at which the largest gain
/// is zero, to 0.5 N/m. To first order in the gain: the swing is taken as if nothing was gained.
double margin_by_played_swings(const SlingshotSetup& setup);

}  // namespace palpate::app
