// SPDX-License-Identifier: AGPL-3.0-or-later
// Where each boundary node and facet of a body lies on the response surface: the picture draws the
// fine boundary and colours it with values of the coarse response vertices.
#pragma once

#include <cstdint>
#include <vector>

#include "format/body.hpp"

namespace palpate::report {

/// Nearest point of a triangle: natural coordinates and squared distance.
struct NearestPoint {
  Vec3 natural{};
  double distance2 = 0;  ///< m^2
};
NearestPoint nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// The boundary with its own numbering (only nodes that bear a facet), and its place on the
/// response surface.
struct SurfaceMap {
  std::vector<std::int32_t> node;            ///< (P) index into Body::nodes
  std::vector<Triangle> facets;              ///< (B) indices into `node`
  std::vector<std::int32_t> facet_triangle;  ///< (B) response triangle nearest to the centroid
  std::vector<std::int32_t> triangle;        ///< (P) nearest response triangle
  std::vector<Vec3> natural;                 ///< (P) natural coordinates in it
};

/// Nearest in distance among the triangles that face the same way, so that thin bodies do not
/// take values from their far side.
SurfaceMap map_boundary(const Body& body);

}  // namespace palpate::report
