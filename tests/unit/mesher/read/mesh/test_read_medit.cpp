// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/mesh/read_medit.hpp"

#include <set>

#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;

const std::string kHead = "MeshVersionFormatted 2\n\nDimension 3\n";
const std::string kVertices = "Vertices\n5\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 1 1 0\n";

TEST(ReadMedit, GivesTheMeshThatGmshStates) {
  const VolumeMesh mesh = test::read_file("gmsh/body.mesh");
  test::expect_body(mesh, "region=4", "region=2", "region=3");
  // Gmsh marks facets by the surface of the geometry; two of these are the base.
  std::set<std::int32_t> base;
  for (const auto& [name, nodes] : mesh.node_sets)
    if (test::heights(mesh, name) == std::pair(0.0, 0.0)) base.insert(nodes.begin(), nodes.end());
  EXPECT_EQ(base.size(), 43U);
}

TEST(ReadMedit, TheMiddlesOfCurvedEdgesLieOnTheBall) {
  const VolumeMesh mesh = test::read_file("gmsh/ball.mesh");
  EXPECT_EQ(mesh.curved_edges.size(), 3 * adjacency(mesh.tetrahedra).boundary.size() / 2);
  for (const CurvedEdge& edge : mesh.curved_edges)
    EXPECT_NEAR(norm(edge.middle - Vec3{1e-3, 2e-3, 3e-3}), 10e-3, 1e-9);
}

TEST(ReadMedit, SkipsCommentsAndSectionsOfOtherThings) {
  const std::string bytes = "# by hand\n" + kHead + "# five\n" + kVertices +
                            "Corners\n2\n1\n2\nTriangles 1\n1 2 3 -4\nNormals\n1\n0 0 -1.5e0\n"
                            "Tetrahedra\n2\n1 2 3 4 0\n2 3 4 5 7 # the last\nEnd\n";
  const MeshEntities mesh = read_medit(bytes, "a.mesh");
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"matrix", "region=7"}));
  EXPECT_EQ(mesh.tetrahedra[1].nodes[3], 4);
  EXPECT_EQ(mesh.node_sets.at("marker=-4"), (std::vector<std::int32_t>{0, 1, 2}));
}

TEST(ReadMedit, CountsElementsOfOtherShapes) {
  const std::string bytes = kHead + kVertices + "Pyramids\n1\n1 2 3 4 5 0\nEnd\n";
  EXPECT_EQ(read_medit(bytes, "a.mesh").other_solids.at("pyramids"), 1U);
}

TEST(ReadMedit, NamesFileAndLineOfAFault) {
  const auto refused = [](const std::string& bytes, const std::string& where,
                          const std::string& problem) {
    expect_refusal([&] { read_medit(bytes, "a.mesh"); }, where, problem);
  };
  refused("solid\n", "a.mesh:1", "does not begin with MeshVersionFormatted");
  refused("MeshVersionFormatted 1\nDimension\n2\n", "a.mesh:3", "dimension 3");
  refused(kHead + kVertices + "Tetrahedra\n1\n1 2 3 6 0\n", "a.mesh:13", "vertex 6");
  refused(kHead + kVertices + "Tetrahedra\n1\n1 2 3 x 0\n", "a.mesh:13", "'x'");
  refused(kHead + kVertices + "Tetrahedra\n1000000000\n1 2 3 4 0\n", "a.mesh:12", "more than");
  refused(kHead + "17\n", "a.mesh:4", "the name of a section");
}

}  // namespace
}  // namespace palpate::mesher
