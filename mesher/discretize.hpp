// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <vector>

#include "mesher/geometry/surface.hpp"
#include "mesher/settings.hpp"
#include "mesher/volume/discretization.hpp"

namespace palpate::mesher {

/// Fills the skin with tetrahedra by the ways that Settings::method allows, in this order:
/// isotropic remeshing of the skin, which keeps sharp edges and nests the boundary facets in the
/// patches, then Delaunay refinement, which meshes what the first cannot. The first result is taken
/// whose dihedral angles are at most kLargestDihedral and whose volume is within kMostVolumeChange
/// of what the skin encloses; the log states why another way was left.
/// @throws Error(Geometry) with the reason of each way when none succeeds.
Discretization discretize(const Settings& settings, const Surface& skin,
                          const std::vector<Surface>& inclusions);

inline constexpr double kLargestDihedral = 175;    ///< degrees
inline constexpr double kMostVolumeChange = 0.03;  ///< in parts of the volume inside the skin

}  // namespace palpate::mesher
