// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/mesh/read_gmsh.hpp"

#include <numbers>

#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;
using test::read_file;

const std::string kHead = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string kNodes = "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n7 0 0 1\n9 1 1 1\n$EndNodes\n";

TEST(ReadGmsh, EveryVersionAndEncodingGivesTheMeshThatGmshStates) {
  for (const char* name : {"gmsh/body_22.msh", "gmsh/body_22_binary.msh", "gmsh/body_41.msh",
                           "gmsh/body_41_binary.msh"}) {
    SCOPED_TRACE(name);
    const VolumeMesh mesh = read_file(name);
    test::expect_body(mesh, "left half", "right half", "nodule");
    EXPECT_EQ(mesh.node_sets.at("base").size(), 43U);
    EXPECT_EQ(mesh.node_sets.at("rim").size(), 5U);
    EXPECT_EQ(test::heights(mesh, "base"), std::pair(0.0, 0.0));
    EXPECT_EQ(test::heights(mesh, "nodule"), std::pair(6.0, 18.0));
  }
}

TEST(ReadGmsh, ReadsVersion1) {
  const VolumeMesh mesh = read_file("gmsh/body_1.msh");
  test::expect_body(mesh, "physical volume 11", "physical volume 12", "physical volume 13");
  EXPECT_EQ(mesh.node_sets.at("physical surface 21").size(), 43U);
}

TEST(ReadGmsh, TakesEveryVersion2AndBlanksBehindKeywords) {
  const std::string bytes = "$MeshFormat \n2 0 8\n$EndMeshFormat\n" + kNodes +
                            "$Elements\n1\n1 4 2 5 1 1 2 3 7\n$EndElements\n";
  EXPECT_EQ(read_gmsh(bytes, "a.msh").tetrahedra.size(), 1U);
}

TEST(ReadGmsh, TheMiddlesOfCurvedEdgesLieOnTheBall) {
  for (const char* name : {"gmsh/ball_41.msh", "gmsh/ball_22_binary.msh"}) {
    SCOPED_TRACE(name);
    const VolumeMesh mesh = read_file(name);
    const auto boundary = adjacency(mesh.tetrahedra).boundary;
    EXPECT_EQ(mesh.curved_edges.size(), 3 * boundary.size() / 2);
    for (const CurvedEdge& edge : mesh.curved_edges) {
      EXPECT_LT(edge.ends[0], edge.ends[1]);
      EXPECT_NEAR(norm(edge.middle - Vec3{1e-3, 2e-3, 3e-3}), 10e-3, 1e-9);
    }
    // The corners of all tetrahedra, and no mid-node.
    EXPECT_EQ(mesh.nodes.size(), 42U);
  }
}

TEST(ReadGmsh, CurvedInterfacesInsideTheBodyAreStraightenedAndLogged) {
  std::string log;
  const VolumeMesh mesh = read_file("gmsh/quadratic_41.msh", test::kMillimetre,
                                    [&](std::string_view line) { log += line; });
  test::expect_body(mesh, "left half", "right half", "nodule");
  EXPECT_THAT(log, testing::HasSubstr("inside the body curved in the file"));
}

TEST(ReadGmsh, NamesGroupsWithoutANameByTheirNumber) {
  const std::string bytes = kHead + kNodes +
                            "$Elements\n4\n1 4 2 5 1 1 2 3 7\n2 4 2 0 2 2 3 7 9\n"
                            "3 2 2 8 4 1 2 3\n4 2 2 0 6 1 2 7\n$EndElements\n";
  const MeshEntities mesh = read_gmsh(bytes, "a.msh");
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"physical volume 5", "matrix"}));
  EXPECT_EQ(mesh.tetrahedra[1].region, 1);
  EXPECT_EQ(mesh.node_sets.at("physical surface 8"), (std::vector<std::int32_t>{0, 1, 2}));
  EXPECT_EQ(mesh.node_sets.at("surface 6"), (std::vector<std::int32_t>{0, 1, 3}));
  EXPECT_EQ(mesh.node_sets.at("volume 2"), (std::vector<std::int32_t>{1, 2, 3, 4}));
}

TEST(ReadGmsh, NamesTheLineOfAFault) {
  const auto refused = [](const std::string& bytes, const std::string& where,
                          const std::string& problem) {
    expect_refusal([&] { read_gmsh(bytes, "a.msh"); }, where, problem);
  };
  refused("solid\n", "a.msh:1", "neither $MeshFormat nor $NOD");
  refused("$MeshFormat\n4.0 0 8\n", "a.msh:2", "version 4 of the MSH format");
  refused(kHead + "$Nodes\n1000000000000000000\n", "a.msh:5", "more than the");
  refused(kHead + "$Nodes\n2\n1 0 0 0\n1 1 0 0\n$EndNodes\n", "a.msh:7", "listed twice");
  refused(kHead + "$Nodes\n2\n1 0 0 0\n2 1 nan 0\n$EndNodes\n", "a.msh:7", "not finite (nan)");
  refused(kHead + "$Nodes\n2\n1 0 0 0\n2 1 zero 0\n$EndNodes\n", "a.msh:7", "'zero'");
  refused(kHead + kNodes + "$Elements\n1\n1 4 0 1 2 3 4\n$EndElements\n", "a.msh:14",
          "element 1 has node 4");
  refused(kHead + kNodes + "$Elements\n1\n1 99 0 1 2 3 4\n$EndElements\n", "a.msh:14",
          "elements of type 99");
  refused(kHead + "$PartitionedEntities\n", "a.msh:4", "partitioned");
  refused(kHead + "$Nodes\n1\n1 0 0 0\n", "a.msh:6", "$EndNodes");
}

}  // namespace
}  // namespace palpate::mesher
