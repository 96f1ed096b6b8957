// SPDX-License-Identifier: AGPL-3.0-or-later
// The coupled response of a node from lateral paths at several depths.
#pragma once

#include <string>
#include <vector>

#include "fitting/response/curve_fit.hpp"
#include "format/curves.hpp"
#include "format/vec3.hpp"

namespace palpate::fitting {

/// The lateral part of a coupled response, E = G(z) + w(z) H(rho): its force is w(z) f^r(rho).
struct CoupledLateral {
  ResponseCurve lateral;  ///< f^r, the lateral force at the depth where w = 1
  CouplingCurve coupling;
};

/// Makes w constant beyond its last knot; where it still rises there, over a further quarter of the
/// depth. A w that grows without limit would have no bound valid at every depth.
void level_off(CouplingCurve& coupling);

/// Fits f_j(rho) = w_j f^r(rho) over the lateral depths z_j by alternating least squares in f^r and
/// w_j, with w = 1 at the middle depth. Then w(z) is interpolated in the logarithms between the
/// lateral depths and extrapolated like sqrt(z), the contact radius of a round tool [Hertz; Mindlin
/// 1949: the lateral stiffness of a bonded contact is proportional to its radius]. Below a
/// twentieth of `depth` it is constant. The fit of the responses makes it a non-decreasing C1
/// curve. With a single lateral depth only the square root remains.
/// @param soft_axis  b of the site: f^r is the response along the stiffest direction
/// @param depth  depth of the normal response, m
/// @param where  name of the site in errors
CoupledLateral fit_coupled(const SiteCurves& site, const Vec3& soft_axis, double depth,
                           const CurveFitSettings& settings, const std::string& where);

}  // namespace palpate::fitting
