// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <vector>

#include "mesher/surface.hpp"

namespace palpate::mesher {

/// Thickness of the body under a tool at each response vertex: the largest distance to the far side
/// along the inward direction, over the vertex and six points around it at `tool_radius`. Next to
/// an edge a single line may leave the body at once although the tool rests on deep material
/// beside it; the largest one tells whether the tool has room. Points of the ring where the surface
/// turns away from the tool are not counted.
/// @param boundary its points begin with the vertices that `inward` belongs to
std::vector<double> thickness_under_tool(const Surface& boundary, const std::vector<Vec3>& inward,
                                         double tool_radius);

}  // namespace palpate::mesher
