// SPDX-License-Identifier: AGPL-3.0-or-later
// A round rod of tetrahedra, and the theory of slender rods under their own weight.
#pragma once

#include "format/body.hpp"

namespace palpate::test {

/// A rod along z from the origin, fixed at z = 0, in `layers` layers. Its cross-section is a
/// polygon of twelve corners with the area of the circle.
Body make_rod(double radius, double length, int layers);

/// The tip of an inextensible rod in the plane of gravity.
struct RodTip {
  double across;  ///< m, from the clamp, normal to gravity
  double along;   ///< m, from the clamp, along gravity
};

/// The elastica under its own weight [Bickley 1934]: EI phi'' = q (L - s) sin phi, with phi the
/// angle from gravity, phi(0) = `clamped` and phi'(L) = 0, by shooting from the tip. `weight`: q,
/// N/m; `bending`: EI, N m^2; `clamped`: rad, 0 .. pi, both excluded.
RodTip heavy_elastica(double weight, double bending, double length, double clamped);

}  // namespace palpate::test
