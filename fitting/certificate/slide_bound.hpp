// SPDX-License-Identifier: AGPL-3.0-or-later
// Bounds of the force while the contact point slides over one triangle.
#pragma once

#include "fitting/certificate/contact_element.hpp"
#include "fitting/certificate/slide_jacobian.hpp"

namespace palpate::fitting {

/// L_stick, N/m: largest norm of the Jacobian at a fixed contact point. Decoupled: the largest
/// slope at any deflection. Coupled: while the lateral deflection is within the slip limit.
double stick_bound(const ContactElement& element);

/// L_min, (10e), N/m: Lipschitz bound of the force at a fixed contact point at any depth, with slip
/// over that point included. The runtime enforces it by rate-limiting slides. Infinite for coupled
/// responses that are flat where slip begins, or whose w grows beyond its last knot.
double min_lipschitz_bound(const ContactElement& element);

/// L_slip, N/m: Lipschitz bound while sliding, (10), in closed form for intervals of depth. Of
/// tissue that relaxes: over fresh tissue.
struct SlideBound {
  double total = 0;      ///< sum of the causes; infinite where (10) gives no bound
  SlideCauses causes{};  ///< at the interval of depth with the largest bound
};

/// Fast enough for every triangle. SlideSearch gives tighter bounds.
SlideBound slide_bound(const ContactElement& element);

/// Whether a slide at limiting friction never raises the stored energy:
///   mu cos(theta) - sin(theta) >= |grad_c E|/g + kappa |rho_s - mu (z + d0)|
/// for all z >= 0, z + d0 <= D, over the whole triangle. The condition is sufficient, not
/// necessary. Always false for coupled responses and for responses that relax.
bool slide_lowers_energy(const ContactElement& element);

}  // namespace palpate::fitting
