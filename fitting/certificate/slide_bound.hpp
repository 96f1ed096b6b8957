// SPDX-License-Identifier: AGPL-3.0-or-later
// Bounds of the force while the contact point slides over one triangle.
#pragma once

#include "fitting/certificate/contact_element.hpp"
#include "fitting/certificate/slide_jacobian.hpp"

namespace palpate::fitting {

/// Largest norm of the Jacobian with the contact point held, N/m. Decoupled: the steepest slope, at
/// any deflection. Coupled: while the lateral deflection is within the slip limit.
double stick_bound(const ContactElement& element);

/// L_hold, (10e), N/m: how steep the force is at any depth with the contact point held, also while
/// the tool slips over it. Infinite for coupled responses that are flat where slip begins, or whose
/// w goes on growing beyond its knots.
double hold_bound(const ContactElement& element);

/// Lipschitz bound along the path while sliding, (10), in closed form for a cell of depths; N/m.
struct SlideBound {
  double total = 0;      ///< the sum of its causes; infinite where no slide can be bounded by it
  SlideCauses causes{};  ///< each at its largest
};

/// Quick, for every triangle; slide_search.hpp looks closer.
SlideBound slide_bound(const ContactElement& element);

/// True when a slide along the surface at limiting friction never raises the stored energy:
///   mu cos(theta) - sin(theta) >= |grad_c E|/g + kappa |rho_s - mu (z + d0)|
/// for all z >= 0, z + d0 <= D, over the whole triangle. Sufficient, not necessary; never claimed
/// of coupled responses.
bool slide_lowers_energy(const ContactElement& element);

}  // namespace palpate::fitting
