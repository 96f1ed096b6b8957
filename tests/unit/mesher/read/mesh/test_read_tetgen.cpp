// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/mesh/read_tetgen.hpp"

#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;

const std::string kNode =
    "# made by hand\n5 3 1 1\n0 0 0 0 5 0\n1 1 0 0 5 2\n2 0 1 0 5 2\n3 0 0 1 5 0\n4 1 1 1 5 0\n";
const std::string kEle = "2 4 1\n0 0 1 2 3 7\n1 1 2 3 4 8 # second\n";

TEST(ReadTetgen, ReadsWhatTetGenWrites) {
  for (const char* name : {"tetgen/cube.node", "tetgen/quadratic.ele"}) {
    SCOPED_TRACE(name);
    const VolumeMesh mesh = test::read_file(name, 1e-2);
    EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"region=7"}));
    EXPECT_NEAR(test::region_sizes(mesh).at("region=7").volume, 1000, 1e-9);  // mm^3
    EXPECT_EQ(test::heights(mesh, "marker=1"), std::pair(0.0, 0.0));
    EXPECT_EQ(test::heights(mesh, "marker=2"), std::pair(10.0, 10.0));
    EXPECT_TRUE(mesh.curved_edges.empty());
  }
  EXPECT_EQ(test::read_file("tetgen/cube.ele", 1e-2).tetrahedra.size(), 68U);
  EXPECT_EQ(test::read_file("tetgen/cube.ele", 1e-2).nodes.size(), 50U);
}

TEST(ReadTetgen, CountsFromZeroOrOneAndTakesMarkersAndAttributes) {
  const MeshEntities mesh =
      read_tetgen({kNode, "a.node"}, {kEle, "a.ele"}, {"1 1\n0 0 1 2 -3\n", "a.face"});
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"region=7", "region=8"}));
  EXPECT_EQ(mesh.node_sets.at("marker=2"), (std::vector<std::int32_t>{1, 2}));
  EXPECT_EQ(mesh.node_sets.at("marker=-3"), (std::vector<std::int32_t>{0, 1, 2}));
}

TEST(ReadTetgen, NamesFileAndLineOfAFault) {
  expect_refusal(
      [] {
        read_tetgen({"1 3 0 0\n", "a.node"}, {kEle, "a.ele"}, {});
      },
      "a.node:1", "more than the");
  expect_refusal(
      [] {
        read_tetgen({"1 3 0 0\n1 0 0\n#####\n", "a.node"}, {kEle, "a.ele"}, {});
      },
      "a.node:2", "the line ends where a coordinate");
  expect_refusal(
      [] {
        read_tetgen({kNode, "a.node"}, {"1 4 0\n0 0 1 2 9\n", "a.ele"}, {});
      },
      "a.ele:2", "node 9 is not in the .node file");
  expect_refusal(
      [] {
        read_tetgen({kNode, "a.node"}, {"1 6 0\n0 0 1 2 3 4\n", "a.ele"}, {});
      },
      "a.ele:1", "tetrahedra of 6 nodes");
  expect_refusal([] { test::read_file("gmsh/missing.node"); }, "missing.node", "no such file");
}

}  // namespace
}  // namespace palpate::mesher
