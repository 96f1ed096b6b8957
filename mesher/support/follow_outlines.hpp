// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "mesher/support/outlines.hpp"

namespace palpate::mesher {

/// Moves nodes of the boundary of a mesh onto the outlines of supports, along the surface, so that
/// its edges do not cross them. A node stays where its tetrahedra would get dihedral angles below 5
/// or above 165 degrees, or worse ones than they have.
/// @param boundary  facets, on the surface of `outlined`
/// @param kept  as many nodes, from the first on, stay where they are
/// @return the number of edges that still cross an outline
std::size_t follow_outlines(const OutlinedSurface& outlined, const std::vector<Triangle>& boundary,
                            const std::vector<Tetrahedron>& tetrahedra, std::vector<Vec3>& nodes,
                            std::size_t kept = 0);

}  // namespace palpate::mesher
