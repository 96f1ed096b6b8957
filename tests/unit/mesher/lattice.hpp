// SPDX-License-Identifier: AGPL-3.0-or-later
// Tetrahedra of unit cubes, to build bodies that touch themselves.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "format/vec3.hpp"

namespace palpate::mesher::test {

using Cell = std::array<int, 3>;
using Cells = std::vector<Cell>;

inline constexpr int kLatticeSide = 5;

/// The node at integer coordinates 0 .. 4.
inline std::int32_t node_at(const Cell& at) {
  return at[0] + kLatticeSide * (at[1] + kLatticeSide * at[2]);
}

struct Lattice {
  std::vector<Vec3> nodes;
  std::vector<Tetrahedron> tetrahedra;
};

/// The unit cubes whose lowest corners these are, of a lattice of 5 x 5 x 5 nodes, in six
/// tetrahedra each [Kuhn 1960]: cubes that share a face share its diagonal.
inline Lattice cubes(const Cells& cells) {
  Lattice mesh;
  for (int k = 0; k < kLatticeSide; ++k)
    for (int j = 0; j < kLatticeSide; ++j)
      for (int i = 0; i < kLatticeSide; ++i) mesh.nodes.push_back({1.0 * i, 1.0 * j, 1.0 * k});
  constexpr std::array<Cell, 6> kOrders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  for (const Cell& cell : cells)
    for (std::size_t order = 0; order < kOrders.size(); ++order) {
      Cell at = cell;
      Tetrahedron t{};
      for (std::size_t corner = 0;; ++corner) {
        t[corner] = node_at(at);
        if (corner == 3) break;
        ++at[static_cast<std::size_t>(kOrders[order][corner])];
      }
      if (order > 2) std::swap(t[1], t[2]);  // odd orders turn the other way
      mesh.tetrahedra.push_back(t);
    }
  return mesh;
}

/// All cells of a block of `side` cells but these.
inline Cells block_without(int side, const Cells& holes) {
  Cells cells;
  for (int k = 0; k < side; ++k)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        const Cell cell{i, j, k};
        if (std::find(holes.begin(), holes.end(), cell) == holes.end()) cells.push_back(cell);
      }
  return cells;
}

/// A ring of cubes that meets in a vertical edge: two cubes that share the edge, and connected
/// cubes above and below it.
inline const Cells kRingAroundAnEdge{{0, 0, 1}, {1, 1, 1}, {0, 0, 0}, {1, 0, 0},
                                     {1, 1, 0}, {0, 0, 2}, {1, 0, 2}, {1, 1, 2}};
inline constexpr Edge kEdgeOfTheRing{6 + 25, 6 + 50};  // from (1, 1, 1) to (1, 1, 2)

/// A ball of tetrahedra around node 0 with two voids that meet in it: bands around three quarters
/// of two great circles, placed like the halves of the cover of a tennis ball. No point sees all
/// facets of either.
inline Lattice two_bands() {
  Lattice ball{{{0, 0, 0}}, {}};
  constexpr int kAcross = 12;  // divisions of each side of a cube
  std::map<std::array<int, 3>, std::int32_t> number;
  const auto node = [&](const std::array<int, 3>& at) {
    const auto [entry, is_new] = number.emplace(at, static_cast<std::int32_t>(ball.nodes.size()));
    if (is_new) ball.nodes.push_back({1.0 * at[0], 1.0 * at[1], 1.0 * at[2]});
    return entry->second;
  };
  // In the frame of a band: its middle, its plane's normal.
  const auto in_band = [](const std::array<int, 3>& at, const Vec3& middle, const Vec3& normal) {
    const Vec3 x{1.0 * at[0], 1.0 * at[1], 1.0 * at[2]};
    return std::abs(dot(x, normal)) < 0.2 * norm(x) &&
           std::atan2(norm(cross(x, middle)), dot(x, middle)) < 2.2;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int side : {-kAcross / 2, kAcross / 2})
      for (int i = -kAcross / 2; i < kAcross / 2; ++i)
        for (int j = -kAcross / 2; j < kAcross / 2; ++j)
          for (const bool upper : {false, true}) {
            std::array<std::array<int, 3>, 3> corners{};
            const std::array<std::array<int, 2>, 3> steps =
                upper ? std::array<std::array<int, 2>, 3>{{{1, 1}, {0, 1}, {1, 0}}}
                      : std::array<std::array<int, 2>, 3>{{{0, 0}, {1, 0}, {0, 1}}};
            bool is_void = false;
            for (std::size_t k = 0; k < 3; ++k) {
              corners[k][axis] = side;
              corners[k][(axis + 1) % 3] = i + steps[k][0];
              corners[k][(axis + 2) % 3] = j + steps[k][1];
              is_void = is_void || in_band(corners[k], {1, 0, 0}, {0, 0, 1}) ||
                        in_band(corners[k], {-1, 0, 0}, {0, 1, 0});
            }
            if (is_void) continue;
            Tetrahedron t{0, node(corners[0]), node(corners[1]), node(corners[2])};
            if (side < 0) std::swap(t[2], t[3]);
            ball.tetrahedra.push_back(t);
          }
  return ball;
}

}  // namespace palpate::mesher::test
