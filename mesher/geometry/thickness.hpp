// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <vector>

#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {

/// Thickness of the body at each response vertex: the distance to the far side along the inward
/// direction.
/// At a vertex of a sharp edge that line may graze the adjoining side and leave the body at once,
/// although the tool rests on deep material beside the edge. There the result is the largest
/// distance from the vertex and from six points around it at `tool_radius` (m); points whose
/// surface faces away from the tool do not count. Thin material beside an edge is reported as thin.
/// @param boundary its first points are the vertices that `inward` belongs to
std::vector<double> thickness_under_tool(const Surface& boundary, const std::vector<Vec3>& inward,
                                         double tool_radius);

}  // namespace palpate::mesher
