// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/manifold.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "mesher/geometry/quality.hpp"
#include "mesher/geometry/surface.hpp"
#include "mesher/volume/boundary.hpp"
#include "mesher/volume/fans.hpp"
#include "tests/unit/mesher/lattice.hpp"

namespace palpate::mesher {
namespace {

using test::cubes;
using test::Lattice;
using test::node_at;

/// One part of elements of positive volume, in a boundary that is a manifold and encloses as much.
/// @return that volume
double volume_of_sound(const Lattice& mesh) {
  double sum = 0;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    EXPECT_GT(volume(mesh.nodes, t), 1e-6);
    sum += volume(mesh.nodes, t);
  }
  const Adjacency found = adjacency(mesh.tetrahedra);
  EXPECT_EQ(found.parts, 1);
  EXPECT_FALSE(found.overlap.has_value());
  EXPECT_TRUE(pinches(found.boundary).nodes.empty());
  EXPECT_NEAR(signed_volume({mesh.nodes, found.boundary, {}, {}}), sum, 1e-12);
  return sum;
}

TEST(Manifold, LeavesAManifoldAlone) {
  Lattice block = cubes(test::block_without(3, {{1, 1, 1}}));
  const Lattice before = block;
  const ManifoldChange change = make_manifold(block.nodes, block.tetrahedra);
  EXPECT_TRUE(change.node_from.empty());
  EXPECT_TRUE(change.tetrahedron_from.empty());
  EXPECT_EQ(block.nodes, before.nodes);
  EXPECT_EQ(block.tetrahedra, before.tetrahedra);
}

TEST(Manifold, HalvesAnEdgeWithARingOfTetrahedraAroundItsEnds) {
  Lattice ring = cubes(test::kRingAroundAnEdge);
  const std::size_t nodes = ring.nodes.size();
  ASSERT_THAT(pinches(adjacency(ring.tetrahedra).boundary).edges,
              testing::ElementsAre(test::kEdgeOfTheRing));
  const ManifoldChange change = make_manifold(ring.nodes, ring.tetrahedra);
  EXPECT_EQ(change.halved_edges, 1U);
  EXPECT_EQ(change.copies, 1U);
  EXPECT_EQ(change.filled_tips, 0U);
  EXPECT_THAT(change.node_from, testing::ElementsAre(test::kEdgeOfTheRing, test::kEdgeOfTheRing));
  for (std::size_t v = nodes; v < ring.nodes.size(); ++v)
    EXPECT_EQ(ring.nodes[v], (Vec3{1, 1, 1.5}));
  EXPECT_NEAR(volume_of_sound(ring), 8, 1e-12);  // the body is the same
}

TEST(Manifold, FillsTheTipOfOneOfTwoVoidsThatMeetInANode) {
  Lattice block = cubes(test::block_without(4, {{1, 1, 1}, {2, 2, 2}}));
  const std::size_t nodes = block.nodes.size(), tetrahedra = block.tetrahedra.size();
  const std::int32_t meeting = node_at({2, 2, 2});
  const ManifoldChange change = make_manifold(block.nodes, block.tetrahedra);
  EXPECT_EQ(change.filled_tips, 1U);
  EXPECT_THAT(change.node_from, testing::ElementsAre(Edge{meeting, meeting}));
  ASSERT_EQ(block.nodes.size(), nodes + 1);
  EXPECT_EQ(change.tetrahedron_from.size(), block.tetrahedra.size() - tetrahedra);
  // A third of an edge along the diagonal, over three sides of a cube of area 1, half of each where
  // the diagonal of the side does not end at the node.
  const Vec3 tip = block.nodes.back() - Vec3{2, 2, 2};
  EXPECT_NEAR(norm(tip), 1.0 / 3, 1e-12);
  EXPECT_NEAR(std::abs(tip[0]), norm(tip) / std::sqrt(3.0), 1e-12);
  const double sides = static_cast<double>(block.tetrahedra.size() - tetrahedra) / 2;
  EXPECT_NEAR(volume_of_sound(block) - 62, sides * std::abs(tip[0]) / 3, 1e-12);
}

TEST(Manifold, NewTetrahedraNameANeighbourOfTheFile) {
  Lattice block = cubes(test::block_without(4, {{1, 1, 1}, {2, 2, 2}}));
  const std::size_t before = block.tetrahedra.size();
  const ManifoldChange change = make_manifold(block.nodes, block.tetrahedra);
  for (std::size_t i = 0; i < change.tetrahedron_from.size(); ++i) {
    const auto from = static_cast<std::size_t>(change.tetrahedron_from[i]);
    ASSERT_LT(from, before);
    Tetrahedron a = block.tetrahedra[from], b = block.tetrahedra[before + i];
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    std::vector<std::int32_t> common;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
    EXPECT_EQ(common.size(), 3U);
  }
}

TEST(Manifold, TipsAreNoHigherThanANearWallAllows) {
  // A wall inside the void, much nearer than its opposite corner: the corner of a tetrahedron of
  // the block is drawn into the void towards the node.
  Lattice block = cubes(test::block_without(4, {{1, 1, 1}, {2, 2, 2}}));
  for (const test::Cell& corner : {test::Cell{3, 3, 3}, test::Cell{1, 1, 1}})
    for (std::size_t k = 0; k < 3; ++k)
      block.nodes[static_cast<std::size_t>(node_at(corner))][k] += corner[0] > 2 ? -0.9 : 0.9;
  make_manifold(block.nodes, block.tetrahedra);
  volume_of_sound(block);
  const double height = norm(block.nodes.back() - Vec3{2, 2, 2});
  EXPECT_NEAR(height, std::sqrt(3.0) * 0.1 / 3, 1e-9);
}

TEST(Manifold, LeavesANodeBetweenVoidsOfWhichNoneCanBeFilled) {
  Lattice ball = test::two_bands();
  for (const Tetrahedron& t : ball.tetrahedra) EXPECT_GT(volume(ball.nodes, t), 0);
  ASSERT_EQ(fans_at(ball.tetrahedra, 0).size(), 2U);
  const ManifoldChange change = make_manifold(ball.nodes, ball.tetrahedra);
  EXPECT_TRUE(change.node_from.empty());
  EXPECT_THAT(pinches(adjacency(ball.tetrahedra).boundary).nodes, testing::ElementsAre(0));
}

}  // namespace
}  // namespace palpate::mesher
