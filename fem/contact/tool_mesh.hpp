// SPDX-License-Identifier: AGPL-3.0-or-later
// The tool as a mesh, for programs whose rigid surfaces are made of facets.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/contact/tool.hpp"
#include "fem/mesh/quadratic_mesh.hpp"

namespace palpate::fem {

/// Quadratic tetrahedra from a point within the tool to six-node facets on the part of its surface
/// that can touch a body: the lower half of a sphere or a lying cylinder, the end and the side of a
/// disc. Every node of a facet lies on the tool. The nodes 0, 1, 2 of a tetrahedron are its facet.
struct ToolMesh {
  Eigen::Matrix3Xd X;  ///< (3, nodes) m
  std::vector<Tetrahedron10> tetrahedra;
};

/// `side`: m, length of the side of a disc. Facets span about 90/`divisions` degrees of a round
/// part, and a `divisions`-th of the radius of a flat one.
ToolMesh make_tool_mesh(const Tool& tool, double side, int divisions = 8);

}  // namespace palpate::fem
