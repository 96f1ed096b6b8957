// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/mesh/assemble.hpp"

#include <limits>

#include "format/to_index.hpp"
#include "mesher/volume/boundary.hpp"
#include "tests/unit/mesher/lattice.hpp"
#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;

void add(MeshEntities& mesh, const Tetrahedron& corners, const std::string& region) {
  ListedTetrahedron& t = mesh.tetrahedra.emplace_back();
  std::copy(corners.begin(), corners.end(), t.nodes.begin());
  t.region = mesh.region(region);
  t.number = 100 + static_cast<std::int64_t>(mesh.tetrahedra.size());
}

void add_nodes(MeshEntities& mesh, const std::vector<Vec3>& nodes) {
  for (const Vec3& x : nodes) {
    mesh.nodes.push_back(x);
    mesh.node_numbers.push_back(10 + static_cast<std::int64_t>(mesh.nodes.size()));
  }
}

/// Two tetrahedra on a common face; nodes 0 and 6 are of neither.
MeshEntities two() {
  MeshEntities mesh;
  add_nodes(mesh, {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {8, 8, 8}});
  add(mesh, {1, 2, 3, 4}, "fat");
  add(mesh, {2, 3, 4, 5}, "muscle");
  return mesh;
}

void refused(const MeshEntities& mesh, const std::string& problem, const std::string& remedy = "") {
  expect_refusal([&] { assemble(mesh, 0.01, "a.msh", {}); }, "a.msh", problem, remedy);
}

TEST(Assemble, DropsUnusedNodesTurnsElementsAndKeepsRegionsAsSets) {
  MeshEntities mesh = two();
  std::swap(mesh.tetrahedra[0].nodes[1], mesh.tetrahedra[0].nodes[2]);
  mesh.region("without elements");
  mesh.node_sets = {{"held", {1, 0, 5, 1}}, {"away", {0, 6}}, {"fat", {5}}};
  std::string log;
  const VolumeMesh found =
      assemble(mesh, 0.01, "a.msh", [&](std::string_view line) { log += line; });
  EXPECT_EQ(found.nodes.size(), 5U);
  EXPECT_EQ(found.nodes[1], (Vec3{0.01, 0, 0}));
  for (const Tetrahedron& t : found.tetrahedra) EXPECT_GT(volume(found.nodes, t), 0);
  EXPECT_EQ(found.region_names, (std::vector<std::string>{"fat", "muscle"}));
  EXPECT_EQ(found.region, (std::vector<std::int32_t>{0, 1}));
  EXPECT_EQ(found.node_sets, (std::map<std::string, std::vector<std::int32_t>>{
                                 {"held", {0, 4}}, {"fat", {4}}, {"muscle", {1, 2, 3, 4}}}));
  EXPECT_THAT(log, testing::HasSubstr("turned 1 tetrahedron of negative volume"));
  EXPECT_THAT(log, testing::HasSubstr("set 'away'"));
}

TEST(Assemble, RefusesOtherShapesAndEmptyMeshes) {
  MeshEntities mesh = two();
  mesh.other_solids = {{"hexahedra", 12}, {"prisms", 1}};
  refused(mesh, "12 hexahedra, 1 prisms", "split them");
  refused(MeshEntities{}, "no tetrahedra", "[surface]");
}

TEST(Assemble, RefusesNumbersThatAreNotFinite) {
  MeshEntities mesh = two();
  mesh.nodes[3][1] = std::numeric_limits<double>::quiet_NaN();
  refused(mesh, "node 14 has a coordinate that is not finite");
}

TEST(Assemble, RefusesAnImplausibleSize) {
  expect_refusal([] { assemble(two(), 1000, "a.msh", {}); }, "a.msh", "largest dimension", "unit");
}

TEST(Assemble, RefusesElementsWithoutVolumeOrWithARepeatedNode) {
  MeshEntities mesh = two();
  mesh.nodes[5] = {0.5, 0.5, 0};  // in the plane of 2, 3 and the middle of 4
  mesh.nodes[5] = {0.3, 0.3, 0.4};
  refused(mesh, "tetrahedron 102 at (3.25, 3.25, 3.5) mm has no volume");
  mesh = two();
  mesh.tetrahedra[0].nodes[2] = 1;
  refused(mesh, "tetrahedron 101");
}

TEST(Assemble, RefusesElementsThatAreListedTwiceOrOverlap) {
  MeshEntities mesh = two();
  add(mesh, {4, 3, 2, 5}, "fat");
  refused(mesh, "1 tetrahedron listed twice: first number 103, a copy of 102");
  mesh = two();
  add_nodes(mesh, {{0.4, 0.4, 0.3}});
  add(mesh, {2, 3, 4, 7}, "fat");
  refused(mesh, "tetrahedra overlap at 1 face");
  mesh = two();
  mesh.nodes[5] = {0.1, 0.1, 0.1};  // on the side of the first
  refused(mesh, "tetrahedra overlap at 1 face");
}

TEST(Assemble, RefusesSeveralPartsAndSaysWhetherNodesCoincide) {
  MeshEntities mesh = two();
  add_nodes(mesh, {{2, 0, 0}, {3, 0, 0}, {2, 1, 0}, {2, 0, 1}});
  add(mesh, {7, 8, 9, 10}, "far");
  refused(mesh, "2 parts that no common face joins; the smallest has 1 tetrahedron, at (22.5",
          "one part");
  mesh = two();
  add_nodes(mesh, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  mesh.tetrahedra[1].nodes = {7, 8, 9, 5};
  refused(mesh, "2 parts", "merge the nodes of equal coordinates");
}

/// Tetrahedra around the axis 0-1 with a gap on each side of it, joined above and, if `below`,
/// below.
MeshEntities ring(bool below) {
  MeshEntities mesh;
  add_nodes(mesh, {{0, 0, 0}, {0, 0, 1}});
  for (int k = 0; k < 8; ++k) {
    const double angle = k * std::numbers::pi / 4;
    add_nodes(mesh, {{std::cos(angle), std::sin(angle), 0.5}});
  }
  add_nodes(mesh, {{0, 0, 2}, {0, 0, -1}});
  for (const std::int32_t k : {0, 1, 4, 5}) add(mesh, {0, 1, 2 + k, 3 + k}, "a");
  for (int k = 0; k < 8; ++k) add(mesh, {1, 2 + k, 2 + (k + 1) % 8, 10}, "a");
  for (int k = 0; below && k < 8; ++k) add(mesh, {0, 2 + k, 2 + (k + 1) % 8, 11}, "a");
  return mesh;
}

TEST(Assemble, HalvesAnEdgeInWhichARingMeetsItself) {
  std::string log;
  const VolumeMesh mesh =
      assemble(ring(true), 0.01, "a.msh", [&](std::string_view line) { log += line; });
  EXPECT_TRUE(pinches(adjacency(mesh.tetrahedra).boundary).nodes.empty());
  EXPECT_THAT(log, testing::HasSubstr("1 edge halved"));
}

TEST(Assemble, RefusesABoundaryThatIsNoManifold) {
  const test::Lattice ball = test::two_bands();
  MeshEntities mesh;
  add_nodes(mesh, ball.nodes);
  for (const Tetrahedron& t : ball.tetrahedra) add(mesh, t, "fat");
  refused(mesh, "not manifold: sheets meet in 0 edges and in 1 point, the first at (0, 0, 0)");
}

TEST(Assemble, SeparatesElementsThatMeetInAnEdgeWhereTheyMeetNowhereElse) {
  std::string log;
  const VolumeMesh mesh =
      assemble(ring(false), 0.01, "a.msh", [&](std::string_view line) { log += line; });
  EXPECT_EQ(mesh.nodes.size(), 12U);  // 11 of the file
  EXPECT_THAT(log, testing::HasSubstr("separated: 1 node added, the first at (0, 0, 0) mm"));
}

}  // namespace
}  // namespace palpate::mesher
