// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/specimen/grid_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

/// The nodes of a grid, moved, with those at one point joined.
class GridNodes {
 public:
  GridNodes(const CellGrid& grid, const std::function<Vec3(const Vec3&)>& map)
      : rows_(grid.first.size()), columns_(grid.second.size()) {
    std::map<Vec3, std::int32_t> at;
    for (const double c : grid.third)
      for (const double b : grid.second)
        for (const double a : grid.first) {
          const auto [place, is_new] =
              at.emplace(map({a, b, c}), static_cast<std::int32_t>(points_.size()));
          if (is_new) points_.push_back(place->first);
          node_.push_back(place->second);
        }
  }

  std::int32_t operator()(const std::array<std::size_t, 3>& i) const {
    return node_[(i[2] * columns_ + i[1]) * rows_ + i[0]];
  }
  const std::vector<Vec3>& points() const { return points_; }

 private:
  std::size_t rows_, columns_;
  std::vector<std::int32_t> node_;  ///< of each point of the grid
  std::vector<Vec3> points_;
};

/// The six tetrahedra of a cell, one for each order of the steps along the axes.
void add_cell(const GridNodes& node, const std::array<std::size_t, 3>& corner,
              std::vector<Tetrahedron>& tetrahedra) {
  constexpr std::size_t kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                         {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (std::size_t o = 0; o < 6; ++o) {
    std::array<std::size_t, 3> at = corner;
    Tetrahedron t{node(at)};
    for (std::size_t s = 0; s < 3; ++s) {
      ++at[kOrders[o][s]];
      t[s + 1] = node(at);
    }
    if (o >= 3) std::swap(t[1], t[2]);  // odd orders are mirror images
    Tetrahedron sorted = t;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end()) tetrahedra.push_back(t);
  }
}

std::vector<Triangle> boundary_of(const std::vector<Tetrahedron>& tetrahedra) {
  std::map<Triangle, int> uses;
  std::vector<Triangle> faces;
  const auto key = [](Triangle face) {
    std::sort(face.begin(), face.end());
    return face;
  };
  for (const Tetrahedron& t : tetrahedra)
    for (const Triangle& face : {Triangle{t[0], t[2], t[1]}, Triangle{t[0], t[1], t[3]},
                                 Triangle{t[1], t[2], t[3]}, Triangle{t[2], t[0], t[3]}}) {
      ++uses[key(face)];
      faces.push_back(face);
    }
  std::erase_if(faces, [&](const Triangle& face) { return uses[key(face)] > 1; });
  return faces;
}

}  // namespace

std::vector<double> graded_cells(double end, double core, double fine, double growth) {
  const double even = std::min(core, end);
  const int cells = std::max(1, static_cast<int>(std::lround(even / fine)));
  std::vector<double> at;
  for (int i = 0; i <= cells; ++i) at.push_back(even * i / cells);
  if (even == end) return at;
  std::vector<double> offset;
  for (double step = growth * fine, x = 0; x < end - even; step *= growth)
    offset.push_back(x += step);
  for (const double x : offset) at.push_back(even + x * (end - even) / offset.back());
  return at;
}

Body grid_body(const CellGrid& grid, const std::function<Vec3(const Vec3&)>& map) {
  const GridNodes nodes(grid, map);
  Body body;
  body.name = "specimen";
  body.region_names = {"specimen"};
  body.nodes = nodes.points();
  for (std::size_t k = 0; k + 1 < grid.third.size(); ++k)
    for (std::size_t j = 0; j + 1 < grid.second.size(); ++j)
      for (std::size_t i = 0; i + 1 < grid.first.size(); ++i)
        add_cell(nodes, {i, j, k}, body.tetrahedra);
  body.tetrahedron_region.assign(body.tetrahedra.size(), 0);
  body.boundary = boundary_of(body.tetrahedra);
  return body;
}

void fix_where(Body& body, const std::function<bool(const Vec3&)>& on_support) {
  for (std::size_t i = 0; i < body.nodes.size(); ++i)
    if (on_support(body.nodes[i])) body.fixed_nodes.push_back(static_cast<std::int32_t>(i));
}

void slide_where(Body& body, const std::function<bool(const Vec3&)>& on_plane, double stiffness) {
  for (std::size_t f = 0; f < body.boundary.size(); ++f) {
    const Triangle& facet = body.boundary[f];
    if (std::all_of(facet.begin(), facet.end(),
                    [&](std::int32_t node) { return on_plane(body.nodes[to_index(node)]); }))
      body.foundation.push_back({static_cast<std::int32_t>(f), stiffness, 0});
  }
  std::sort(body.foundation.begin(), body.foundation.end(),
            [](const SprungFacet& a, const SprungFacet& b) { return a.facet < b.facet; });
}

}  // namespace palpate::fem
