// SPDX-License-Identifier: AGPL-3.0-or-later
// Inclusions: closed surfaces inside the skin that bound regions of the body.
#pragma once

#include <vector>

#include "mesher/geometry/surface.hpp"
#include "mesher/settings.hpp"
#include "mesher/volume/domain.hpp"
#include "mesher/volume/fill.hpp"
#include "mesher/volume/volume_mesh.hpp"

namespace palpate::mesher {

/// @throws Error(Geometry) when an inclusion intersects the skin or another inclusion, lies outside
///   the skin, or contains another inclusion.
void check_inclusions(const Settings& settings, const Surface& skin,
                      const std::vector<Surface>& inclusions);

/// The regions of the body as Delaunay refinement takes them: inclusions may touch, cross and
/// contain one another, the later ones win.
/// @throws Error(Geometry) when an inclusion lies outside the skin.
Domain domain_of(const Settings& settings, const Surface& skin,
                 const std::vector<Surface>& inclusions);

/// Inclusions with the volume that they have, and edges near element_size; half as long at most
/// where the inclusion is small: half the radius of the ball with its volume over its area.
std::vector<Surface> remesh_inclusions(const Settings& settings,
                                       const std::vector<Surface>& inclusions);

/// The boundary and the inclusions as one list of triangles, the boundary first.
/// @throws Error(Geometry) when they intersect after remeshing.
Surface join_shells(const Settings& settings, const Surface& boundary,
                    const std::vector<Surface>& inclusions);

/// The tetrahedra with their regions: region 0 is the matrix, region 1 + i is inclusion i.
VolumeMesh with_regions(const Settings& settings, const Filling& filling,
                        const std::vector<Surface>& inclusions);

}  // namespace palpate::mesher
