// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/init/facet_width.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <vector>

#include "format/edge.hpp"
#include "format/to_index.hpp"
#include "mesher/settings.hpp"

namespace palpate::app {
namespace {

constexpr double kBend = std::numbers::pi / 180;  // rad; flatter edges are part of a face

}  // namespace

double facet_width(const mesher::Surface& surface) {
  std::map<Edge, std::vector<Vec3>> normals;  // of the facets at each edge
  for (const Triangle& t : surface.triangles) {
    const Vec3 normal = mesher::unit(mesher::area_vector(surface.points, t));
    for (std::size_t i = 0; i < 3; ++i)
      normals[edge_between(t[i], t[(i + 1) % 3])].push_back(normal);
  }
  std::vector<double> lengths;
  for (const auto& [edge, sides] : normals) {
    if (sides.size() != 2) continue;
    const double bend = std::atan2(norm(cross(sides[0], sides[1])), dot(sides[0], sides[1]));
    if (bend > kBend && bend < mesher::Settings{}.feature_angle)
      lengths.push_back(
          norm(surface.points[to_index(edge[1])] - surface.points[to_index(edge[0])]));
  }
  if (lengths.empty()) return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

}  // namespace palpate::app
