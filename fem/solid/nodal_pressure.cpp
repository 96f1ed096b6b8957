// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/solid/nodal_pressure.hpp"

#include <algorithm>

#include "format/to_index.hpp"

namespace palpate::fem {

NodalPressure::NodalPressure(const QuadraticMesh& mesh, const std::vector<int>& elements,
                             const std::vector<int>& equation)
    : regions_(1 + *std::max_element(mesh.region.begin(), mesh.region.end())) {
  std::int32_t last_corner = 0;
  for (const Tetrahedron10& t : mesh.tetrahedra)
    last_corner = std::max(last_corner, *std::max_element(t.begin(), t.begin() + 4));
  point_at_.assign((to_index(last_corner) + 1) * to_index(regions_), -1);
  for (const int e : elements)
    for (std::size_t c = 0; c < 4; ++c) {
      const std::size_t place = key(mesh, e, c);
      int& point = point_at_[place];
      if (point >= 0) continue;
      point = static_cast<int>(points_.size());
      points_.push_back({static_cast<int>(place), mesh.region[to_index(e)], 0, {}});
    }
  for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); ++e) {
    const std::array<int, 4> mine = points_of(mesh, e);
    if (std::ranges::all_of(mine, [](int point) { return point < 0; })) continue;
    elements_.push_back(e);
    for (const int point : mine) {
      if (point < 0) continue;
      points_[to_index(point)].volume += 0.25 * volume_of(mesh, e);
      for (const auto node : mesh.tetrahedra[to_index(e)])
        if (equation[to_index(node)] >= 0) points_[to_index(point)].nodes.push_back(node);
    }
  }
  for (Point& point : points_) {
    std::sort(point.nodes.begin(), point.nodes.end());
    point.nodes.erase(std::unique(point.nodes.begin(), point.nodes.end()), point.nodes.end());
  }
}

std::size_t NodalPressure::key(const QuadraticMesh& mesh, int element, std::size_t corner) const {
  return to_index(mesh.tetrahedra[to_index(element)][corner]) * to_index(regions_) +
         to_index(mesh.region[to_index(element)]);
}

std::size_t NodalPressure::bytes() const {
  std::size_t nodes = 0;
  for (const Point& point : points_) nodes += point.nodes.size();
  return sizeof(int) * (nodes + point_at_.size() + elements_.size()) +
         sizeof(Point) * points_.size();
}

std::array<int, 4> NodalPressure::points_of(const QuadraticMesh& mesh, int element) const {
  std::array<int, 4> mine{};
  for (std::size_t c = 0; c < 4; ++c) mine[c] = point_at_[key(mesh, element, c)];
  return mine;
}

}  // namespace palpate::fem
