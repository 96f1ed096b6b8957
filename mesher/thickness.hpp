// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <vector>

#include "mesher/surface.hpp"

namespace palpate::mesher {

/// Thickness of the body at each response vertex: the distance to the far side along the inward
/// direction. At a vertex of a sharp edge that line may graze the adjoining side and leave the body
/// at once although the tool rests on deep material beside it; there the largest distance counts,
/// over the vertex and six points around it at `tool_radius` (m), without those where the surface
/// turns away from the tool. Thin material beside an edge is thin and is reported as such.
/// @param boundary its points begin with the vertices that `inward` belongs to
std::vector<double> thickness_under_tool(const Surface& boundary, const std::vector<Vec3>& inward,
                                         double tool_radius);

}  // namespace palpate::mesher
