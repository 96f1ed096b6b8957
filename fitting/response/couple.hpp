// SPDX-License-Identifier: AGPL-3.0-or-later
// The coupled response of a node from lateral paths at several depths.
#pragma once

#include <string>
#include <vector>

#include "fitting/response/curve_fit.hpp"
#include "format/curves.hpp"

namespace palpate::fitting {

/// The lateral part of a coupled response, E = G(z) + w(z) H(rho): its force is w(z) f^r(rho).
struct CoupledLateral {
  ResponseCurve lateral;  ///< f^r, the lateral force at the depth where w = 1
  CouplingCurve coupling;
};

/// Beyond its last knot w stays where it is, which its slope reaches over a further quarter of the
/// depth: a w that grows without end has no bound at every depth.
void level_off(CouplingCurve& coupling);

/// Held depths of the lateral paths of a site, ascending.
std::vector<double> lateral_depths(const SiteCurves& site);

/// Least squares for f_j(rho) = w_j f^r(rho) over the held depths z_j, by turns in f^r and w_j; w
/// is 1 at the middle one. Then w(z): straight in the logarithms between the held depths, beyond
/// them like the radius of contact of a round tool, sqrt(z) [Hertz; Mindlin 1949: a stuck contact
/// is laterally as stiff as it is wide], from a twentieth of `depth` on, below which it is
/// constant; made a non-decreasing C1 curve by the same fit as every response. With a single held
/// depth the square root is all there is.
/// @param depth of the normal response, m. @param where names the site in errors.
CoupledLateral fit_coupled(const SiteCurves& site, double depth, const CurveFitSettings& settings,
                           const std::string& where);

}  // namespace palpate::fitting
