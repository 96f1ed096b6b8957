// SPDX-License-Identifier: AGPL-3.0-or-later
// The facets of a boundary around one of its nodes.
#pragma once

#include <array>
#include <vector>

#include "format/vec3.hpp"

namespace palpate::mesher {

/// The boundary facets with this node: one closed fan for each void that meets the tetrahedra at
/// it.
/// @pre no edge at the node has more than two facets.
std::vector<std::vector<Triangle>> fans_at(const std::vector<Tetrahedron>& tetrahedra,
                                           std::int32_t node);

/// A fan and the direction, away from the body, that makes the largest angle with its nearest
/// facet.
struct OpenFan {
  std::vector<Triangle> facets;
  Vec3 direction{};
  double least_sine = -1;  ///< of those angles; not positive where no point sees all facets
};
OpenFan open_fan(const std::vector<Vec3>& nodes, std::vector<Triangle> facets);

/// The distance from the node along the direction to the first facet without it; infinite where
/// there is none.
double way_across(const std::vector<Vec3>& nodes, const std::vector<Triangle>& boundary,
                  std::int32_t node, const Vec3& direction);

/// Whether the point lies strictly inside the tetrahedron of these corners.
bool is_inside(const std::array<Vec3, 4>& corners, const Vec3& x);

}  // namespace palpate::mesher
