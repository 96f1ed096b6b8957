// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "format/to_index.hpp"
#include "mesher/skin/curve_edges.hpp"
#include "mesher/skin/remesh.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

TEST(CurveEdges, MiddlesOfASphereLieOnIt) {
  constexpr double kRadius = 0.05;
  const Surface input = test::sphere({0, 0, 0}, kRadius, 200);
  const Surface facets = remesh(input, {0.012, 1, std::numbers::pi / 4}, "sphere", {}).boundary;
  const std::vector<CurvedEdge> curved = curve_edges(facets, input);
  EXPECT_EQ(curved.size(), 3 * facets.triangles.size() / 2);
  for (const CurvedEdge& edge : curved) EXPECT_NEAR(norm(edge.middle), kRadius, 2e-5);
}

TEST(CurveEdges, EdgesInAPlaneAreStraight) {
  const Surface box = test::box({0, 0, 0}, {0.05, 0.04, 0.03});
  EXPECT_TRUE(curve_edges(box, box).empty());
}

// The chord between two neighbouring faces of a cube cuts off its edge: the middle is too far.
TEST(CurveEdges, AChordAcrossASharpEdgeStaysStraight) {
  const Surface box = test::box({0, 0, 0}, {1, 1, 1});
  const Surface chord{{{0.5, 0.2, 1}, {1, 0.2, 0.5}, {0.8, 0.4, 1}}, {{0, 1, 2}}, {}, {}};
  for (const CurvedEdge& edge : curve_edges(chord, box)) EXPECT_NE(edge.ends, (Edge{0, 1}));
}

}  // namespace
}  // namespace palpate::mesher
