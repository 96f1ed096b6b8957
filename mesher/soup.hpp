// SPDX-License-Identifier: AGPL-3.0-or-later
// Polygons as a file lists them, and the checks that need no geometry: indices, finite numbers,
// edges, orientation, parts.
#pragma once

#include <string>
#include <vector>

#include "format/vec3.hpp"
#include "mesher/surface.hpp"
#include "mesher/text.hpp"

namespace palpate::mesher {

struct Soup {
  std::vector<Vec3> points;
  std::vector<std::vector<std::size_t>> polygons;
  std::vector<std::size_t> names;  ///< of each polygon, as in Surface; may be empty
  std::vector<Names> known_names;
};

/// Harmless repair, each step logged when it does something: points with exactly equal coordinates
/// become one (an STL file names every corner anew), and so do points of a border that differ by
/// 2e-6 of the largest coordinate or less; polygons that thereby lose their third corner
/// and points of no polygon are dropped.
void tidy(Soup& soup, const std::string& where, const Log& log);

/// @throws Error(Geometry) when a polygon has fewer than three corners or an index out of range, a
///   coordinate is not finite, or there is no polygon at all.
void check_entries(const Soup& soup, const std::string& where);

/// @throws Error(Geometry) with the counts when an edge does not have exactly two polygons or a
///   point joins several sheets.
void check_manifold(const Soup& soup, const std::string& where);

/// Turn the polygons so that neighbours agree; those turned are logged.
/// @pre check_manifold passed.
/// @throws Error(Geometry) when no consistent orientation exists or there are several parts.
void orient(Soup& soup, const std::string& where, const Log& log);

}  // namespace palpate::mesher
