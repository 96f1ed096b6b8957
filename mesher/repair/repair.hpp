// SPDX-License-Identifier: AGPL-3.0-or-later
// From the faces of a file, as they are, to a closed surface that bounds one volume.
#pragma once

#include <string>
#include <vector>

#include "mesher/geometry/soup.hpp"
#include "mesher/geometry/surface.hpp"
#include "mesher/geometry/text.hpp"
#include "mesher/repair/repair_settings.hpp"

namespace palpate::mesher {

/// What a repair did to the surface.
struct RepairReport {
  std::vector<std::string> steps;          ///< one sentence each, in the order of the work
  double area_before = 0, area_after = 0;  ///< m^2
  double volume = 0;                       ///< m^3, after the repair
  double moved = 0;  ///< m, largest distance of the original surface from the repaired one
  Vec3 moved_at{};   ///< m, where
  double added = 0;  ///< m, largest distance of the repaired surface from the original one
  Vec3 added_at{};   ///< m, where: the middle of the largest hole
};

/// Whether the faces bound one volume: manifold, closed, consistently oriented, in one part,
/// without triangles of zero area and without self-intersections.
bool is_sound(const Soup& soup);

/// A closed, outward-oriented surface from faces with faults. In this order: near points are
/// merged, duplicate faces removed, T-junctions split, faces oriented and sheets that meet in an
/// edge or a point separated, borders stitched, negligible parts removed, holes filled, degenerate
/// faces removed, self-intersections removed. Each step that changes something is named in the
/// report. Names of faces are those of the nearest face of the file.
/// @throws Error(Geometry) with the place and a remedy where a hole is larger than max_hole,
/// several
///   parts remain, faults remain, or the surface would move by more than max_change.
Surface repair(const Soup& soup, const RepairSettings& settings, const std::string& where,
               RepairReport& report);

/// The alpha wrap [Portaneri et al. 2022] of the faces: closed and free of self-intersections
/// whatever the faces are. Details smaller than `alpha` (m) are bridged; the wrap lies `offset` (m)
/// outside.
Surface alpha_wrap(const Soup& soup, double alpha, double offset);

}  // namespace palpate::mesher
