// SPDX-License-Identifier: AGPL-3.0-or-later
// The cap of a ball on a rigid core: its stiffness does not depend on the position.
#pragma once

#include <vector>

#include "fem/campaign/campaign.hpp"

namespace palpate::test {

/// Pole up at (0, 0, radius), soft from the core out.
struct RoundCap {
  double radius = 0.030, thickness = 0.015;  ///< m
  double half_angle = 0.9;                   ///< rad, of the cap
  double young = 10e3, poisson = 0.45;       ///< Pa, 1
};

/// Rings at ascending angles from the pole, layers at descending depths below the skin from the
/// thickness to 0; flat facets, the inside fixed.
Body cap_of(const RoundCap& cap, const std::vector<double>& angles, int sectors,
            const std::vector<double>& depths);

/// Elements of one size everywhere.
Body even_cap(const RoundCap& cap, double size);

/// The same with curved facets and the pole as its only response vertex.
Body curved_cap(double size);

struct Spread {
  double mean = 0;       ///< N
  double deviation = 0;  ///< standard deviation over the positions, over the mean
};

/// Presses a tool along the radius onto the facets whose middles are within `near` of the pole: at
/// the middle of each, of an edge and at a corner, each from the skin that is there. @return of the
/// forces along the radius, at each of the `increments` down to `depth`.
std::vector<Spread> spread_of_force(const RoundCap& cap, const Body& body,
                                    const fem::IndentationSettings& press, double near);

}  // namespace palpate::test
