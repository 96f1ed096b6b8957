// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <vector>

#include "format/body.hpp"
#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

/// The edges of `boundary` whose middles, put on the nearest point of `input`, leave the middle of
/// the chord. Middles farther than a tenth of the edge lie across a sharp edge of the input or on
/// another sheet: such edges stay straight.
std::vector<CurvedEdge> curve_edges(const Surface& boundary, const Surface& input);

}  // namespace palpate::mesher
