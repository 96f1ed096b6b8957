// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/fans.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mesher/geometry/surface.hpp"
#include "mesher/volume/boundary.hpp"
#include "tests/unit/mesher/lattice.hpp"

namespace palpate::mesher {
namespace {

using test::cubes;
using test::Lattice;
using test::node_at;

TEST(Fans, OneForEachVoidThatMeetsTheNode) {
  // Opposite octants around the middle of a block are void.
  const Lattice block = cubes(test::block_without(2, {{0, 0, 0}, {1, 1, 1}}));
  const auto fans = fans_at(block.tetrahedra, node_at({1, 1, 1}));
  ASSERT_EQ(fans.size(), 2U);
  for (const auto& facets : fans) {
    // Each is closed, and its facets are those of three faces of a cube, which have a side each.
    double sum = 0;
    for (std::size_t i = 0; i < facets.size(); ++i) {
      EXPECT_EQ(facets[i][0], node_at({1, 1, 1}));
      EXPECT_EQ(facets[i][2], facets[(i + 1) % facets.size()][1]);
      sum += norm(area_vector(block.nodes, facets[i])) / 2;
    }
    EXPECT_NEAR(sum, 3, 1e-12);  // the Kuhn diagonals of these octants end at the node
  }
}

TEST(Fans, TheWidestDirectionOfACornerIsItsDiagonal) {
  const Lattice block = cubes(test::block_without(2, {{1, 1, 1}}));
  auto fans = fans_at(block.tetrahedra, node_at({1, 1, 1}));
  ASSERT_EQ(fans.size(), 1U);
  const OpenFan fan = open_fan(block.nodes, fans.front());
  for (const double c : fan.direction) EXPECT_NEAR(c, 1 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(fan.least_sine, 1 / std::sqrt(3.0), 1e-12);
}

TEST(Fans, NoDirectionSeesAllFacetsOfAVoidThatWindsAroundTheNode) {
  const Lattice block = cubes(test::block_without(2, {{1, 1, 1}, {0, 1, 1}, {0, 0, 1}, {0, 0, 0}}));
  auto fans = fans_at(block.tetrahedra, node_at({1, 1, 1}));
  ASSERT_EQ(fans.size(), 1U);
  EXPECT_LE(open_fan(block.nodes, fans.front()).least_sine, 1e-12);
}

TEST(Fans, TheWayAcrossACubicVoidIsItsDiagonal) {
  const Lattice block = cubes(test::block_without(3, {{1, 1, 1}}));
  const auto boundary = adjacency(block.tetrahedra).boundary;
  const Vec3 diagonal = unit({1, 1, 1});
  const std::int32_t corner = node_at({1, 1, 1});
  // Facets at the corner itself do not count, nor those behind it.
  EXPECT_NEAR(way_across(block.nodes, boundary, corner, diagonal), std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(way_across(block.nodes, boundary, corner, unit({1, 2, 3})), std::sqrt(14.0) / 3,
              1e-12);
  EXPECT_TRUE(std::isinf(way_across(block.nodes, boundary, node_at({3, 3, 3}), diagonal)));
}

TEST(Fans, PointsOnATetrahedronAreNotInsideIt) {
  const std::array<Vec3, 4> corners{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  EXPECT_TRUE(is_inside(corners, {0.2, 0.2, 0.2}));
  for (const Vec3& corner : corners) EXPECT_FALSE(is_inside(corners, corner));
  EXPECT_FALSE(is_inside(corners, {0.5, 0.5, 0}));
  EXPECT_FALSE(is_inside(corners, {0.4, 0.4, 0.4}));
  EXPECT_FALSE(is_inside(corners, {0.2, 0.2, -0.2}));
}

}  // namespace
}  // namespace palpate::mesher
