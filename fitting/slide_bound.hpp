// SPDX-License-Identifier: AGPL-3.0-or-later
// Bounds of the force while the contact point slides over one triangle.
#pragma once

#include <optional>
#include <vector>

#include "fitting/curve_bounds.hpp"
#include "fitting/triangle_frame.hpp"

namespace palpate::fitting {

/// A triangle with its responses and the friction the bounds are for.
struct ContactElement {
  TriangleFrame frame;
  CurveTriple normal;
  CurveTriple lateral;
  double friction = 0;
  double depth = 0;                                    ///< m, D: the bounds hold while z + d0 <= D
  std::optional<CurveTriple> coupling = std::nullopt;  ///< w, of coupled responses

  /// Ends of cells of depth without a knot of a normal response, or of w, inside.
  std::vector<double> depth_cells() const;
};

/// Largest norm of the Jacobian with the contact point held, N/m. Decoupled: the steepest slope, at
/// any deflection. Coupled: while the lateral deflection is within the slip limit.
double stick_bound(const ContactElement& element);

/// Lipschitz bound along the path while sliding, and the parts it is the sum of, N/m.
struct SlideBound {
  double total = 0;       ///< L_slip; infinite where the slide itself is not bounded
  double stiffness = 0;   ///< steepness of the responses at a fixed contact point
  double variation = 0;   ///< change of the responses over the surface
  double slant = 0;       ///< directions u_l that lean against the facet
  double curvature = 0;   ///< turning of n
  double slide_rate = 0;  ///< largest path of the contact point for a unit path of the tool
};

SlideBound slide_bound(const ContactElement& element);

/// True when a slide along the surface at limiting friction never raises the stored energy:
///   mu cos(theta) - sin(theta) >= |grad_c E|/g + kappa |rho_s - mu (z + d0)|
/// for all z >= 0, z + d0 <= D, over the whole triangle. Sufficient, not necessary; never claimed
/// of coupled responses.
bool slide_lowers_energy(const ContactElement& element);

}  // namespace palpate::fitting
