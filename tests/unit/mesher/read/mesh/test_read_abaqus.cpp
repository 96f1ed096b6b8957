// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/mesh/read_abaqus.hpp"

#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;
using test::read_file;

const std::string kNodes = "*NODE, NSET=ALL\n1, 0,0,0\n2, 1,0,0\n3, 0,1,0\n4, 0,0,1\n9, 1,1,1.\n";

TEST(ReadAbaqus, ReadsWhatMeshioWrites) {
  const VolumeMesh mesh = read_file("meshio/body.inp");
  test::expect_body(mesh, "left", "right", "nodule");
  EXPECT_EQ(mesh.node_sets.at("base").size(), 43U);
}

TEST(ReadAbaqus, ReadsWhatGmshWrites) {
  const VolumeMesh mesh =
      read_volume_mesh({test::mesh_file("gmsh/body.inp"),
                        test::kMillimetre,
                        "",
                        {{"left_half", "left"}, {"right_half", "right"}, {"nodule", "stiff"}}},
                       {});
  test::expect_body(mesh, "left", "right", "stiff");
  EXPECT_EQ(mesh.node_sets.at("base").size(), 43U);
  EXPECT_EQ(test::heights(mesh, "left_half"), std::pair(0.0, 20.0));
}

TEST(ReadAbaqus, QuadraticElementsKeepTheirCurvedBoundary) {
  const VolumeMesh mesh = read_file("gmsh/ball.inp");
  EXPECT_EQ(mesh.nodes.size(), 42U);
  for (const CurvedEdge& edge : mesh.curved_edges)
    EXPECT_NEAR(norm(edge.middle - Vec3{1e-3, 2e-3, 3e-3}), 10e-3, 1e-9);
  EXPECT_EQ(mesh.curved_edges.size(), 3 * adjacency(mesh.tetrahedra).boundary.size() / 2);
}

TEST(ReadAbaqus, FollowsSetsRangesSurfacesAndSections) {
  const MeshEntities mesh =
      read_abaqus("*Heading\n free text, 1\n** comment\n" + kNodes +
                      "*Element, type=C3D4H, elset=Both\n10, 1,2,3,4\n20, 2,3,4,9\n"
                      "*ELSET, ELSET=first\n10\n*elset, elset=\"second\", GENERATE\n20, 40, 10\n"
                      "*Nset, nset=odd, generate\n1, 9, 2\n*NSET, NSET=low\nODD, 2\n"
                      "*Nset, nset=ofset, elset=FIRST\n"
                      "*Surface, name=side, type=ELEMENT\nSecond, S3\n10, S1\n"
                      "*Solid Section, elset=First, material=fat\n1.,\n*SOLID SECTION, "
                      "ELSET=SECOND,\nMATERIAL=b\n"
                      "*Step\n*Static\n1., 1.\n*End Step\n",
                  "a.inp");
  ASSERT_EQ(mesh.tetrahedra.size(), 2U);
  EXPECT_EQ(mesh.region_names[static_cast<std::size_t>(mesh.tetrahedra[0].region)], "first");
  EXPECT_EQ(mesh.region_names[static_cast<std::size_t>(mesh.tetrahedra[1].region)], "second");
  EXPECT_EQ(mesh.node_sets.at("odd"), (std::vector<std::int32_t>{0, 2, 4}));
  EXPECT_EQ(mesh.node_sets.at("low"), (std::vector<std::int32_t>{0, 2, 4, 1}));
  EXPECT_EQ(mesh.node_sets.at("ofset"), (std::vector<std::int32_t>{0, 1, 2, 3}));
  // S3 of the second has its corners 2, 3, 4: nodes 3, 9, 4; S1 of the first nodes 1, 2, 3.
  EXPECT_THAT(mesh.node_sets.at("side"), testing::UnorderedElementsAre(2, 4, 3, 0, 1, 2));
}

TEST(ReadAbaqus, NodesOfAnElementContinueOnTheNextLine) {
  const MeshEntities mesh = read_abaqus(
      "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n5,.5,0,0\n6,.5,.5,0\n7,0,.5,0\n8,0,0,.5\n"
      "9,.5,0,.5\n10,0,.5,.5\n*ELEMENT, TYPE=C3D10, ELSET=a\n1,1,2,3,4,5,\n6,7,8,9,10\n",
      "a.inp");
  ASSERT_EQ(mesh.tetrahedra.size(), 1U);
  EXPECT_TRUE(mesh.tetrahedra[0].quadratic);
  EXPECT_EQ(mesh.tetrahedra[0].nodes, (std::array<std::int32_t, 10>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST(ReadAbaqus, CountsWhatIsNoTetrahedron) {
  const MeshEntities mesh = read_abaqus(
      kNodes + "*ELEMENT, TYPE=C3D5\n1, 1,2,3,4,9\n*ELEMENT, TYPE=S3, ELSET=skin\n2, 1,2,3\n",
      "a.inp");
  EXPECT_EQ(mesh.other_solids, (std::map<std::string, std::size_t>{{"pyramids", 1}}));
  EXPECT_EQ(mesh.node_sets.at("skin"), (std::vector<std::int32_t>{0, 1, 2}));
}

TEST(ReadAbaqus, NamesTheLineOfAFault) {
  const auto refused = [](const std::string& bytes, const std::string& where,
                          const std::string& problem) {
    expect_refusal([&] { read_abaqus(bytes, "a.inp"); }, where, problem);
  };
  refused("*HEADING\nnothing\n", "a.inp:2", "no *NODE");
  refused(kNodes + "*INCLUDE, INPUT=b.inp\n", "a.inp:7", "*include");
  refused(kNodes + "*NODE\n2, 0,0,0\n", "a.inp:8", "node 2 is listed twice");
  refused(kNodes + "*NODE\n5, 0,inf,0\n", "a.inp:8", "not finite");
  refused(kNodes + "*ELEMENT, TYPE=C3D4\n1, 1,2,3,5\n", "a.inp:8", "node 5");
  refused(kNodes + "*ELEMENT, TYPE=C3D4\n1, 1,2,3\n*STEP\n", "a.inp:9", "has 3 nodes");
  refused(kNodes + "*ELEMENT\n", "a.inp:7", "without TYPE");
  refused(kNodes + "*NSET, NSET=a\nb\n", "a.inp:8", "no node set 'b'");
  refused(kNodes + "*ELSET, ELSET=a\n7\n", "a.inp:", "element 7");
  refused(kNodes + "*NSET, NSET=a, GENERATE\n1, 0\n", "a.inp:8", "from 1 to 0");
  refused("*PART, NAME=A\n*END PART\n*PART, NAME=B\n", "a.inp:3", "several parts");
  refused("*INSTANCE, NAME=A, PART=B\n1., 0., 0.\n", "a.inp:1", "moved");
  refused("*NODE, SYSTEM=C\n1,1,90,0\n", "a.inp:1", "cylindrical");
}

}  // namespace
}  // namespace palpate::mesher
