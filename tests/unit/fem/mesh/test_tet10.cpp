// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/mesh/tet10.hpp"

#include <gtest/gtest.h>

namespace palpate::fem {
namespace {

TEST(Tet10, NumbersTheNodeBetweenTwoCorners) {
  for (std::size_t e = 0; e < kTetEdges.size(); ++e) {
    const auto [a, b] = kTetEdges[e];
    EXPECT_EQ(middle_node(a, b), 4 + e);
    EXPECT_EQ(middle_node(b, a), 4 + e);
  }
}

/// The interpolant of L_i L_j on the nodes has its derivatives, up to a multiple of sum L = 1.
TEST(Tet10, DifferentiatesQuadraticFieldsExactly) {
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t q = 0; q < kTetPoints; ++q) {
        std::array<double, 4> slope{};
        for (std::size_t node = 0; node < kTetNodes; ++node) {
          std::array<double, 4> L{};
          if (node < 4) {
            L[node] = 1;
          } else {
            for (const std::size_t corner : kTetEdges[node - 4]) L[corner] = 0.5;
          }
          for (std::size_t c = 0; c < 4; ++c) slope[c] += kTetShape[q][node][c] * L[i] * L[j];
        }
        const auto at = [&](std::size_t c) { return c == q ? kTetNear : kTetFar; };
        const auto exact = [&](std::size_t c) {
          return (c == i ? at(j) : 0) + (c == j ? at(i) : 0);
        };
        for (std::size_t c = 1; c < 4; ++c)
          EXPECT_NEAR(slope[c] - slope[0], exact(c) - exact(0), 1e-14);
      }
}

}  // namespace
}  // namespace palpate::fem
