// SPDX-License-Identifier: AGPL-3.0-or-later
// Where supports end on the skin.
#pragma once

#include <vector>

#include "mesher/geometry/surface.hpp"
#include "mesher/settings.hpp"

namespace palpate::mesher {

/// What is fixed, or stands on the springs of one foundation, as a part of a surface.
struct SupportedPart {
  std::vector<bool> inside;   ///< each triangle of the surface
  std::vector<Edge> outline;  ///< the edges between triangles inside and outside
};

/// The same surface, with triangles divided so that each lies inside a support or outside.
struct OutlinedSurface {
  Surface surface;
  std::vector<SupportedPart> parts;  ///< the fixed supports together, then each foundation
};

/// Outlines of planes and names are exact. Those of other shapes are polylines with points on the
/// outline, in steps of at most a quarter of the size of the skin. A flat face that lies inside by
/// up to a twentieth of that size ends at its own edges.
/// @throws Error(Configuration) when no face has the name of a LabelSupport.
OutlinedSurface with_outlines(const Surface& skin, const Settings& settings);

}  // namespace palpate::mesher
