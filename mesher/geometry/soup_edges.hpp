// SPDX-License-Identifier: AGPL-3.0-or-later
// The neighbourhood of the polygons of a soup, and what is wrong with it.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "mesher/geometry/faulty_faces.hpp"

namespace palpate::mesher {

struct Soup;  // mesher/geometry/soup.hpp, whose source defines these functions

using SoupEdge = std::pair<std::size_t, std::size_t>;  ///< two points, ascending
using PolygonsOfEdges = std::map<SoupEdge, std::vector<std::size_t>>;

PolygonsOfEdges polygons_of_edges(const Soup& soup);

/// Points whose polygons do not form a single fan: sheets that meet in a point only.
/// @pre every point has a polygon
std::vector<std::size_t> pinched_points(const Soup& soup, const PolygonsOfEdges& edges);

/// Edges of two polygons that are oriented differently.
std::vector<SoupEdge> discordant_edges(const Soup& soup, const PolygonsOfEdges& edges);

/// The polygons at edges that do not have two of them, and those at points.
FaultyFaces faces_at_edges(const Soup& soup, const PolygonsOfEdges& edges);
FaultyFaces faces_at_points(const Soup& soup, const std::vector<std::size_t>& points);

}  // namespace palpate::mesher
