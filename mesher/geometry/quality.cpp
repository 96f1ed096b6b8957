// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/geometry/quality.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "format/to_index.hpp"
#include "mesher/geometry/text.hpp"

namespace palpate::mesher {
namespace {

constexpr std::array<std::array<std::size_t, 4>, 6> kEdgeAndOpposite = {
    {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};

/// Angle in degrees between the half planes through the edge ab that contain c and d.
double dihedral(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 m = cross(b - a, c - a);
  const Vec3 n = cross(b - a, d - a);
  return std::atan2(norm(cross(m, n)), dot(m, n)) * 180 / std::numbers::pi;
}

}  // namespace

double volume(const std::vector<Vec3>& nodes, const Tetrahedron& t) {
  const auto at = [&](std::size_t k) { return nodes[to_index(t[k])]; };
  return dot(cross(at(1) - at(0), at(2) - at(0)), at(3) - at(0)) / 6;
}

Quality measure_quality(const std::vector<Vec3>& nodes,
                        const std::vector<Tetrahedron>& tetrahedra) {
  Quality quality;
  for (const Tetrahedron& t : tetrahedra) {
    const auto at = [&](std::size_t k) { return nodes[to_index(t[k])]; };
    double shortest = norm(at(1) - at(0)), longest = shortest;
    for (const auto& [a, b, c, d] : kEdgeAndOpposite) {
      const double angle = dihedral(at(a), at(b), at(c), at(d));
      quality.smallest_dihedral = std::min(quality.smallest_dihedral, angle);
      if (angle > quality.largest_dihedral) {
        quality.largest_dihedral = angle;
        quality.largest_dihedral_at = 0.5 * (at(a) + at(b));
      }
      const double length = norm(at(b) - at(a));
      shortest = std::min(shortest, length);
      longest = std::max(longest, length);
    }
    quality.largest_edge_ratio = std::max(quality.largest_edge_ratio, longest / shortest);
    quality.longest_edge = std::max(quality.longest_edge, longest);
    quality.volume += volume(nodes, t);
  }
  return quality;
}

std::string summary(const Quality& quality) {
  return text("dihedral angles ", quality.smallest_dihedral, " to ", quality.largest_dihedral,
              " degrees, largest edge ratio ", quality.largest_edge_ratio, ", longest edge ",
              millimetres(quality.longest_edge), ", volume ", 1e6 * quality.volume, " cm^3");
}

}  // namespace palpate::mesher
