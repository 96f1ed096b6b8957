// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/mesh/mid_nodes.hpp"

#include "mesher/read/mesh/assemble.hpp"
#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;

/// Quadratic tetrahedra 1-2-3-4 and 2-3-4-5 around a common face, mid-nodes halfway.
MeshEntities two() {
  MeshEntities mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  std::map<Edge, std::int32_t> middles;
  for (const Tetrahedron& corners : {Tetrahedron{0, 1, 2, 3}, Tetrahedron{1, 2, 3, 4}}) {
    ListedTetrahedron& t = mesh.tetrahedra.emplace_back();
    std::copy(corners.begin(), corners.end(), t.nodes.begin());
    t.quadratic = true;
    t.number = static_cast<std::int64_t>(mesh.tetrahedra.size());
    for (std::size_t k = 0; k < 6; ++k) {
      const auto [a, b] = kTetrahedronEdges[k];
      Edge ends{corners[a], corners[b]};
      if (ends[1] < ends[0]) std::swap(ends[0], ends[1]);
      const auto [found, is_new] =
          middles.try_emplace(ends, static_cast<std::int32_t>(mesh.nodes.size()));
      if (is_new)
        mesh.nodes.push_back(0.5 * (mesh.nodes[static_cast<std::size_t>(ends[0])] +
                                    mesh.nodes[static_cast<std::size_t>(ends[1])]));
      t.nodes[4 + k] = found->second;
    }
  }
  mesh.region("a");
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    mesh.node_numbers.push_back(static_cast<std::int64_t>(i));
  return mesh;
}

TEST(MidNodes, HalfwayIsStraight) {
  EXPECT_TRUE(assemble(two(), 0.01, "a", {}).curved_edges.empty());
  EXPECT_EQ(assemble(two(), 0.01, "a", {}).nodes.size(), 5U);
}

TEST(MidNodes, BulgesOfTheBoundaryStayWhereTheyAre) {
  MeshEntities mesh = two();
  mesh.nodes[static_cast<std::size_t>(mesh.tetrahedra[0].nodes[4])] = {0.5, -0.1, 0};
  const VolumeMesh found = assemble(mesh, 0.01, "a", {});
  ASSERT_EQ(found.curved_edges.size(), 1U);
  EXPECT_EQ(found.curved_edges[0], (CurvedEdge{{0, 1}, {0.005, -0.001, 0}}));
}

TEST(MidNodes, TurnedElementsKeepTheirMidNodes) {
  MeshEntities mesh = two();
  auto& nodes = mesh.tetrahedra[0].nodes;
  nodes = {nodes[0], nodes[2], nodes[1], nodes[3], nodes[6],
           nodes[5], nodes[4], nodes[7], nodes[9], nodes[8]};
  EXPECT_TRUE(assemble(mesh, 0.01, "a", {}).curved_edges.empty());
}

TEST(MidNodes, RefusesBulgesOfMoreThanAQuarterAndTwoMiddlesOfOneEdge) {
  MeshEntities mesh = two();
  mesh.nodes[static_cast<std::size_t>(mesh.tetrahedra[0].nodes[4])] = {0.5, -0.3, 0};
  expect_refusal([&] { assemble(mesh, 0.01, "a.inp", {}); }, "a.inp",
                 "the mid-node of an edge of tetrahedron 1 lies 0.3 of the length", "refine");
  mesh = two();
  mesh.tetrahedra[1].nodes[4] = static_cast<std::int32_t>(mesh.nodes.size());
  mesh.nodes.push_back({0.5, 0.6, 0});
  mesh.node_numbers.push_back(99);
  expect_refusal([&] { assemble(mesh, 0.01, "a.inp", {}); }, "a.inp",
                 "tetrahedra 1 and 2 have different mid-nodes", "merge");
}

}  // namespace
}  // namespace palpate::mesher
