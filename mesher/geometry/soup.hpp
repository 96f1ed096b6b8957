// SPDX-License-Identifier: AGPL-3.0-or-later
// Polygons as listed in a file, and the checks that need no geometry: indices, finite numbers,
// edges, orientation, parts.
#pragma once

#include <string>
#include <vector>

#include "format/vec3.hpp"
#include "mesher/geometry/surface.hpp"
#include "mesher/geometry/text.hpp"

namespace palpate::mesher {

struct Soup {
  std::vector<Vec3> points;
  std::vector<std::vector<std::size_t>> polygons;
  std::vector<std::size_t> names;  ///< of each polygon, as in Surface; may be empty
  std::vector<Names> known_names;
};

/// Repairs what can be repaired without a choice, and logs each step that changes something.
/// Points with equal coordinates are merged (an STL file repeats every corner), and so are points
/// of a border that differ by at most 2e-6 of the largest coordinate. Polygons that are left with
/// fewer than three corners and points of no polygon are dropped.
void tidy(Soup& soup, const std::string& where, const Log& log);

/// @throws Error(Geometry) when a polygon has fewer than three corners or an index out of range, a
///   coordinate is not finite, or there is no polygon at all.
void check_entries(const Soup& soup, const std::string& where);

/// @throws FaultySurface with the counts when an edge does not have exactly two polygons or a point
///   connects several sheets.
void check_manifold(const Soup& soup, const std::string& where);

/// Reverses polygons until neighbours are oriented alike, and logs how many.
/// @pre check_manifold passed.
/// @throws Error(Geometry) when no consistent orientation exists or there are several parts.
void orient(Soup& soup, const std::string& where, const Log& log);

}  // namespace palpate::mesher
