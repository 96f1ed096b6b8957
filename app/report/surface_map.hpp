// SPDX-License-Identifier: AGPL-3.0-or-later
// Position of boundary nodes and facets of a body on the response surface. The picture draws the
// boundary in the colours of the response vertices.
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

/// The boundary with its own numbering (only nodes that bear a facet), and its position on the
/// response surface.
struct SurfaceMap {
  std::vector<std::int32_t> node;            ///< (P) index into Body::nodes
  std::vector<Triangle> facets;              ///< (B) indices into `node`
  std::vector<std::int32_t> facet_triangle;  ///< (B) response triangle nearest to the centroid
  std::vector<std::int32_t> triangle;        ///< (P) nearest response triangle
  std::vector<Vec3> natural;                 ///< (P) natural coordinates in it
};

/// Value at each of the points of a field that is given at the corners of triangles: that of the
/// nearest point of these.
std::vector<double> nearest_values(const std::vector<Vec3>& points,
                                   const std::vector<Vec3>& corners,
                                   const std::vector<Triangle>& triangles,
                                   const std::vector<double>& values);

/// Uses the nearest of the triangles with the same orientation, so that the two sides of thin
/// bodies do not mix.
SurfaceMap map_boundary(const Body& body);

}  // namespace palpate::report
