// SPDX-License-Identifier: Apache-2.0
// How far the origin is from what three points span: the least |sum n_l u_l| of three directions
// over the natural coordinates of a triangle.
#pragma once

#include <algorithm>

#include "format/vec3.hpp"

namespace palpate {

/// From the segment a b; from the point, where the ends are one.
inline double origin_to_segment(const Vec3& a, const Vec3& b) {
  const Vec3 edge = b - a;
  const double length2 = dot(edge, edge);
  const double s = length2 > 0 ? std::clamp(-dot(a, edge) / length2, 0.0, 1.0) : 0.0;
  return norm(a + s * edge);
}

/// From the triangle a b c, of whatever orientation; from its edges, where it is flat.
inline double origin_to_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double to_edges =
      std::min({origin_to_segment(a, b), origin_to_segment(b, c), origin_to_segment(c, a)});
  const Vec3 n = cross(b - a, c - a);
  const double length2 = dot(n, n);
  if (length2 <= 0) return to_edges;
  const Vec3 foot = (dot(a, n) / length2) * n;
  const bool inside = dot(cross(b - a, foot - a), n) >= 0 && dot(cross(c - b, foot - b), n) >= 0 &&
                      dot(cross(a - c, foot - c), n) >= 0;
  return inside ? norm(foot) : to_edges;
}

}  // namespace palpate
