// SPDX-License-Identifier: AGPL-3.0-or-later
// Checks of the settings before meshing and of the body after it.
#pragma once

#include <string>

#include "format/body.hpp"
#include "mesher/geometry/surface.hpp"
#include "mesher/settings.hpp"
#include "mesher/volume/volume_mesh.hpp"

namespace palpate::mesher {

/// @throws Error(Configuration) for a setting out of range.
void check_settings(const Settings& settings);

/// Compares the settings with the size of the skin before anything is computed.
/// @throws Error(Configuration) for patches larger than a third of the body, which usually means a
///   wrong unit, or elements so small that the mesh would have more than two million nodes;
///   Error(Geometry) for a lateral travel longer than the body, which every drag would leave.
void check_sizes(const Settings& settings, const Surface& skin);

/// Largest number of nodes of a mesh, and of facets of its boundary.
inline constexpr double kMostNodes = 2e6;

/// About the nodes of a mesh of the skin without layers and inclusions.
double nodes_of(const Settings& settings, const Surface& skin);

/// Excludes the sites where the depth is more than 0.8 of the thickness: nominal strains beyond
/// -0.8 are outside the range of the laws and of a mesh of this kind. The log states how many and
/// where.
/// @throws Error(Geometry) when that is more than half of the sites: then the depth is wrong, not a
///   few thin places.
void exclude_thin_sites(Body& body, const Settings& settings, const Surface& boundary);

/// @throws Error(Geometry) when a tetrahedron has no volume to speak of: TetGen leaves such slivers
///   under facets that it may not change.
void check_elements(const VolumeMesh& volume, const std::string& where);

/// @throws Error(Internal) when the tetrahedra do not fill the boundary.
void check_filled(const VolumeMesh& volume, const Surface& boundary, const std::string& where);

}  // namespace palpate::mesher
