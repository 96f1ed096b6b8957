// SPDX-License-Identifier: AGPL-3.0-or-later
// Checks of the regions inside the body before anything is meshed.
#pragma once

#include <vector>

#include "mesher/geometry/surface.hpp"
#include "mesher/settings.hpp"

namespace palpate::mesher {

/// Compares each inclusion with the body.
/// @throws Error(Geometry), with both sizes and the units that would fit, for an inclusion whose
///   bounding box does not meet that of the body, or that is larger than the body in every
///   direction where another unit would fit; and for one that encloses the whole body. A larger
///   inclusion that no unit makes fit is cut off by the skin.
void check_places(const Settings& settings, const Surface& skin,
                  const std::vector<Surface>& inclusions);

/// Estimates the nodes of layers and inclusions that are thin beside the elements: these become as
/// small as the layer or sheet. The log warns of those that take more nodes than all else, and of
/// those too thin to be resolved.
/// @throws Error(Configuration) for a layer, Error(Geometry) for an inclusion that needs more nodes
///   than a mesh may have.
void check_thinness(const Settings& settings, const Surface& skin,
                    const std::vector<Surface>& inclusions);

}  // namespace palpate::mesher
