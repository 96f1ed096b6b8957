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
  std::vector<std::string> warnings;       ///< what a user should look at
  double area_before = 0, area_after = 0;  ///< m^2
  double volume = 0;                       ///< m^3, after the repair
  double moved = 0;  ///< m, largest distance of the parts that were kept from the result
  Vec3 moved_at{};   ///< m, where
  double added = 0;  ///< m, largest distance of the result from the parts that were kept
  Vec3 added_at{};   ///< m, where: the middle of the largest hole
  Surface kept;      ///< the faces of the file that were kept; may have borders and crossings
};

/// A closed, outward-oriented surface from faces with faults.
///
/// Local repairs come first, in this order: near points are merged, duplicate faces removed,
/// T-junctions split, faces oriented and sheets that meet in an edge or a point separated, borders
/// stitched, negligible parts removed, holes filled, degenerate faces removed, self-intersections
/// removed. They may move 2 % of the area by up to twice max_change, with a warning. Where faults
/// remain, or the surface moves by more, the alpha wrap of
/// the faces and of the patches in the holes replaces it: that of alpha = 1/50 of the extent if at
/// most 2 % of the area of the file is farther than max_change from it, else that of 1/100.
///
/// Each step that changes something is named in the report. Names of faces are those of the nearest
/// face of the file.
/// @throws FaultySurface with the place and a remedy where several parts remain, the faces bound no
///   volume, or more than 10 % of their area is farther than max_change from the finest wrap.
Surface repair(const Soup& soup, const RepairSettings& settings, const std::string& where,
               RepairReport& report);

}  // namespace palpate::mesher
