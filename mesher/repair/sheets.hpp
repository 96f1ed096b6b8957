// SPDX-License-Identifier: AGPL-3.0-or-later
// From faces that may be turned, doubled or shared by several sheets to oriented sheets.
#pragma once

#include "mesher/geometry/soup.hpp"
#include "mesher/geometry/surface.hpp"
#include "mesher/repair/points.hpp"

namespace palpate::mesher {

/// Drops faces that occur twice, whatever their orientation but for one of them, and faces that
/// have fewer than three distinct corners.
void remove_duplicate_faces(Soup& soup, Steps& steps);

struct Sheets {
  Surface surface;         ///< manifold, with or without borders
  bool separated = false;  ///< some met in an edge or a point
};

/// Orients the faces, separates sheets that meet in an edge or a point, splits polygons into
/// triangles and stitches borders whose points coincide.
Sheets connect(const Soup& soup, Steps& steps);

}  // namespace palpate::mesher
