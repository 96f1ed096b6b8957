// SPDX-License-Identifier: AGPL-3.0-or-later
// The straight-sided quadratic tetrahedron in volume coordinates L_0..L_3.
#pragma once

#include <array>
#include <cstddef>

namespace palpate::fem {

inline constexpr std::size_t kTetNodes = 10;
inline constexpr std::size_t kTetPoints = 4;

/// Corner nodes 0..3; mid-edge node 4 + e lies between the corners kTetEdges[e].
inline constexpr std::array<std::array<std::size_t, 2>, 6> kTetEdges{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

/// The node between two different corners a and b.
constexpr std::size_t middle_node(std::size_t a, std::size_t b) {
  std::size_t e = 0;
  while (kTetEdges[e] != std::array{a, b} && kTetEdges[e] != std::array{b, a}) ++e;
  return 4 + e;
}

/// Volume coordinates of the four Gauss points, exact to degree 2, each of weight 1/4
/// [Zienkiewicz & Taylor 2000, table 9.2].
inline constexpr double kTetNear = 0.5854101966249685, kTetFar = 0.1381966011250105;

/// dN_a/dL_c at Gauss point q: N_a = L_a (2 L_a - 1) at corners, 4 L_i L_j at mid-edges, the four
/// L taken as independent (their gradients sum to zero).
constexpr std::array<std::array<double, 4>, kTetNodes> shape_derivatives(std::size_t q) {
  std::array<double, 4> L{};
  for (std::size_t c = 0; c < 4; ++c) L[c] = c == q ? kTetNear : kTetFar;
  std::array<std::array<double, 4>, kTetNodes> B{};
  for (std::size_t c = 0; c < 4; ++c) B[c][c] = 4 * L[c] - 1;
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [i, j] = kTetEdges[e];
    B[4 + e][i] = 4 * L[j];
    B[4 + e][j] = 4 * L[i];
  }
  return B;
}

inline constexpr std::array<std::array<std::array<double, 4>, kTetNodes>, kTetPoints> kTetShape{
    shape_derivatives(0), shape_derivatives(1), shape_derivatives(2), shape_derivatives(3)};

/// dN_a/dL_c is linear in L. With every L = kTetFar it is 4 kTetFar - 1 for the corner c and
/// 4 kTetFar for the nodes between c and other corners; at Gauss point q it is kTetStep more for
/// the node kTetBetween[q][c], the corner c where q = c.
inline constexpr double kTetStep = 4 * (kTetNear - kTetFar);
inline constexpr std::array<std::array<std::size_t, 4>, kTetPoints> kTetBetween = [] {
  std::array<std::array<std::size_t, 4>, kTetPoints> between{};
  for (std::size_t q = 0; q < 4; ++q)
    for (std::size_t c = 0; c < 4; ++c) between[q][c] = q == c ? c : middle_node(q, c);
  return between;
}();

}  // namespace palpate::fem
