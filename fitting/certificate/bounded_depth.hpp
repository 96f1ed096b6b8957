// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <vector>

#include "fitting/certificate/triangle_bounds.hpp"
#include "format/library.hpp"

namespace palpate::fitting {

/// Largest depth D, m, such that every slide with z + d0 <= D has a finite bound by the responses
/// alone; to a 64th of `depth`, from below. 0: none, as at a sharp edge.
/// @param bounds  of triangle_bounds() for `depth`, m, and the friction coefficient
double bounded_depth(const Library& library, const std::vector<TriangleBounds>& bounds,
                     double depth, double friction);

}  // namespace palpate::fitting
