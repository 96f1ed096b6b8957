// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/boundary.hpp"

#include <gtest/gtest.h>

#include "mesher/geometry/quality.hpp"
#include "mesher/geometry/surface.hpp"

namespace palpate::mesher {
namespace {

const std::vector<Vec3> kPoints{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};

TEST(Boundary, EnclosesTheVolumeOfTheTetrahedra) {
  const std::vector<Tetrahedron> tetrahedra{{0, 1, 2, 3}, {1, 2, 3, 4}};
  const Adjacency found = adjacency(tetrahedra);
  EXPECT_EQ(found.boundary.size(), 6U);
  EXPECT_EQ(found.parts, 1);
  EXPECT_FALSE(found.overlap.has_value());
  double sum = 0;
  for (const Tetrahedron& t : tetrahedra) sum += volume(kPoints, t);
  EXPECT_NEAR(signed_volume({kPoints, found.boundary, {}, {}}), sum, 1e-15);
  EXPECT_EQ(components(found.boundary), 1U);
  EXPECT_TRUE(pinches(found.boundary).nodes.empty());
}

TEST(Boundary, PartsShareNoFace) {
  // The second has an edge in common with the first, the third a point with the second.
  const Adjacency found = adjacency({{0, 1, 2, 3}, {0, 1, 4, 5}, {4, 6, 7, 8}});
  EXPECT_EQ(found.parts, 3);
  EXPECT_EQ(found.part, (std::vector<std::int32_t>{0, 1, 2}));
}

TEST(Boundary, FacesOfThreeTetrahedraOverlap) {
  const Adjacency found = adjacency({{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 2, 1, 5}});
  EXPECT_EQ(found.overlaps, 1U);
  EXPECT_TRUE(adjacency({{0, 1, 2, 3}, {0, 1, 2, 4}}).overlap.has_value());  // on one side
}

TEST(Boundary, PinchesAreEdgesOfFourFacetsAndPointsOfTwoFans) {
  const auto surface = [](const std::vector<Tetrahedron>& tetrahedra) {
    return adjacency(tetrahedra).boundary;
  };
  const Pinches edge = pinches(surface({{0, 1, 2, 3}, {0, 1, 4, 5}}));
  EXPECT_EQ(edge.edges, (std::vector<Edge>{{0, 1}}));
  EXPECT_EQ(edge.points, 0U);
  const Pinches point = pinches(surface({{0, 1, 2, 3}, {0, 4, 5, 6}}));
  EXPECT_TRUE(point.edges.empty());
  EXPECT_EQ(point.points, 1U);
  EXPECT_EQ(point.nodes, (std::vector<std::int32_t>{0}));
}

}  // namespace
}  // namespace palpate::mesher
