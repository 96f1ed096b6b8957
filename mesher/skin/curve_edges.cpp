// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/skin/curve_edges.hpp"

#include "format/edge.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/queries.hpp"

namespace palpate::mesher {
namespace {

constexpr double kLargestBulge = 0.1;  // in parts of the length of an edge
constexpr double kRounding = 1e-9;     // the same: a straight edge

}  // namespace

std::vector<CurvedEdge> curve_edges(const Surface& boundary, const Surface& input) {
  const SurfaceQuery query(input);
  std::vector<CurvedEdge> curved;
  for (const Edge& ends : edges_of(boundary.triangles)) {
    const Vec3 a = boundary.points[to_index(ends[0])], b = boundary.points[to_index(ends[1])];
    const Vec3 straight = 0.5 * (a + b);
    const Vec3 middle = query.closest(straight).point;
    const double bulge = norm(middle - straight) / norm(b - a);
    if (bulge > kRounding && bulge <= kLargestBulge) curved.push_back({ends, middle});
  }
  return curved;
}

}  // namespace palpate::mesher
