// SPDX-License-Identifier: AGPL-3.0-or-later
// A bar or a cylinder between two glued clamps or plates that move apart or together.
#pragma once

#include <vector>

#include "fem/laws/law_table.hpp"

namespace palpate::fem {

struct ClampedSpecimen {
  double length = 0;                ///< m, between the clamps
  double width = 0, thickness = 0;  ///< m, of a rectangular section
  double diameter = 0;              ///< m, of a round one, where the others are 0
  LawConstants law;

  double area() const;  ///< m^2, of the section at rest
};

/// Force on the clamps over the area at rest, Pa, at stretches of the length, in the order given,
/// each from the state before it. Three planes of symmetry leave an eighth of a bar; of a cylinder
/// half a sector of 30 degrees is left.
/// @throws Error(Configuration) for sizes that are not positive, a stretch that is not, constants
///   out of range, and a stretch that has no stable equilibrium, with how far the path came.
std::vector<double> clamped_stress(const ClampedSpecimen& specimen,
                                   const std::vector<double>& stretches);

}  // namespace palpate::fem
