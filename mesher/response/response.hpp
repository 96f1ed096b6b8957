// SPDX-License-Identifier: AGPL-3.0-or-later
// The response surface of a body: press directions and sites.
#pragma once

#include <optional>
#include <vector>

#include "format/body.hpp"
#include "mesher/geometry/surface.hpp"
#include "mesher/response/slide_directions.hpp"
#include "mesher/settings.hpp"
#include "mesher/skin/remesh.hpp"
#include "mesher/support/supports.hpp"

namespace palpate::mesher {

struct InwardDirections {
  std::vector<Vec3> inward;              ///< unit, one for each response vertex
  std::size_t adjusted = 0;              ///< number of directions that differ from the mean normal
  double largest_turn = 0;               ///< rad, largest angle to the mean normal
  std::size_t turned_most = 0;           ///< response vertex with the largest angle
  std::vector<std::int32_t> unresolved;  ///< response vertices of triangles that break a condition
  /// Triangles whose slides have no bound, or nearly none, before directions turn for them and
  /// after: as far as the shape alone says.
  std::size_t unbounded = 0, still_unbounded = 0;
};

/// The negated angle-weighted mean of the facet normals around each response vertex
/// [Thuermer & Wuthrich 1998], turned until the conditions of the runtime are met on every triangle
/// with a site:
///   |sum n_l u_l| >= 0.5 for all natural coordinates n, and u_l . outward normal < 0.
/// Facets whose nodes are all constrained do not count where others meet at the vertex, so that
/// beside a support the direction is that of the free side.
/// @param constrained one entry for each point of `boundary`, whose first points are the response
///   vertices: fixed or on springs
/// @param demand none: slides are not considered
InwardDirections inward_directions(const Surface& response, const Surface& boundary,
                                   const Marks& constrained,
                                   const std::optional<SlideDemand>& demand = {});

/// Writes Body::response and logs which vertices are no sites: those that are constrained, those
/// within tool_radius of a constrained point, where the tool would press on the support instead of
/// the body, and those without a press direction.
void set_response(Body& body, const NestedSurface& nested, const Marks& constrained,
                  const Settings& settings);

/// @throws Error(Geometry) when no response vertex is a site.
void check_sites(const Body& body, const Settings& settings, const Surface& boundary);

}  // namespace palpate::mesher
