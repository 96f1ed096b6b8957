// SPDX-License-Identifier: AGPL-3.0-or-later
// What the response surface carries: supports, inward directions.
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/mesher.hpp"
#include "mesher/queries.hpp"
#include "mesher/surface.hpp"

namespace palpate::mesher {

/// True where any support but a SurfaceSupport or a LabelSupport holds the point; `tolerance` (m)
/// widens each support so that nodes lying on its border but for rounding are held.
bool is_held(const std::vector<Support>& supports, const Vec3& point, double tolerance);

/// Whether all corners are marked.
bool all_held(const Triangle& t, const std::vector<std::uint8_t>& held);

/// True for points inside a closed surface or within `distance` of it.
bool is_near(const SurfaceQuery& surface, const Vec3& point, double distance);

struct InwardDirections {
  std::vector<Vec3> inward;              ///< unit, one for each response vertex
  std::size_t adjusted = 0;              ///< directions turned away from the mean normal
  double largest_turn = 0;               ///< rad, of the one that was turned most
  std::size_t turned_most = 0;           ///< its response vertex
  std::vector<std::int32_t> unresolved;  ///< response vertices of triangles that break a condition
};

/// The negated angle-weighted mean of the facet normals around each response vertex, turned as far
/// as the runtime needs it on every triangle with a site:
///   |sum n_l u_l| >= 0.5 for all natural coordinates n, and u_l . outward normal < 0.
/// Facets wholly held by a support do not count where others are there, so that next to a support
/// the direction is that of the touchable side.
/// @param held one entry for each boundary point, which begin with those of the response surface
InwardDirections inward_directions(const Surface& response, const Surface& boundary,
                                   const std::vector<std::uint8_t>& held);

}  // namespace palpate::mesher
