// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/interfaces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "format/to_index.hpp"
#include "mesher/volume/boundary.hpp"

namespace palpate::mesher {
namespace {

/// Two tetrahedra that share the node 0, or the edge 0 1, or a face.
VolumeMesh pair_sharing(int nodes) {
  VolumeMesh mesh;
  mesh.nodes = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {-1, -1, -1}};
  mesh.tetrahedra = {{0, 2, 3, 1}};
  if (nodes == 1) mesh.tetrahedra.push_back({0, 5, 4, 6});
  if (nodes == 2) mesh.tetrahedra.push_back({0, 4, 5, 1});
  if (nodes == 3) mesh.tetrahedra.push_back({0, 3, 4, 1});
  mesh.region = {0, 1};
  return mesh;
}

TEST(Interfaces, FacetsOfATetrahedronPointOutward) {
  const VolumeMesh mesh = pair_sharing(3);
  const Surface boundary = boundary_surface(mesh);
  EXPECT_EQ(boundary.triangles.size(), 6U);
  EXPECT_EQ(boundary.points.size(), 5U);
  EXPECT_NEAR(signed_volume(boundary), 2.0 / 6, 1e-15);
  EXPECT_EQ(interface_facets(mesh).size(), 7U);
}

TEST(Interfaces, TouchingInANodeOrAnEdgeIsNotManifoldAndIsTakenApart) {
  const auto pinched = [](const VolumeMesh& mesh) {
    return pinches(adjacency(mesh.tetrahedra).boundary).nodes;
  };
  for (const int nodes : {1, 2}) {
    VolumeMesh mesh = pair_sharing(nodes);
    EXPECT_EQ(pinched(mesh).front(), 0);
    EXPECT_EQ(pinched(mesh).size(), to_index(nodes));
    EXPECT_THAT(adjacency(mesh.tetrahedra).part, testing::ElementsAre(0, 1));
    const auto origin = split_nodes(mesh.tetrahedra, mesh.nodes.size());
    EXPECT_EQ(origin.size(), to_index(nodes));
    for (const std::int32_t v : origin) mesh.nodes.push_back(Vec3(mesh.nodes[to_index(v)]));
    EXPECT_TRUE(pinched(mesh).empty());
    EXPECT_NEAR(signed_volume(boundary_surface(mesh)), 2.0 / 6, 1e-15);
  }
  VolumeMesh mesh = pair_sharing(3);
  EXPECT_TRUE(pinched(mesh).empty());
  EXPECT_THAT(adjacency(mesh.tetrahedra).part, testing::ElementsAre(0, 0));
  EXPECT_TRUE(split_nodes(mesh.tetrahedra, mesh.nodes.size()).empty());
}

TEST(Interfaces, KeepsTheLargestSetAndItsNodes) {
  VolumeMesh mesh = pair_sharing(1);
  mesh.nodes[2] = {3, 0, 0};
  const auto set = adjacency(mesh.tetrahedra).part;
  ASSERT_EQ(largest_set(mesh, set), 0);
  keep_set(mesh, set, 0);
  EXPECT_EQ(mesh.nodes.size(), 4U);
  EXPECT_EQ(mesh.tetrahedra.size(), 1U);
  EXPECT_THAT(mesh.region, testing::ElementsAre(0));
}

}  // namespace
}  // namespace palpate::mesher
