// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/mesh/separate_sheets.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "mesher/volume/boundary.hpp"
#include "tests/unit/mesher/lattice.hpp"

namespace palpate::mesher {
namespace {

using test::Cells;
using test::node_at;

void add(MeshEntities& mesh, const Tetrahedron& corners) {
  std::copy(corners.begin(), corners.end(), mesh.tetrahedra.emplace_back().nodes.begin());
}

std::vector<Tetrahedron> corners_of(const MeshEntities& mesh) {
  std::vector<Tetrahedron> corners;
  for (const ListedTetrahedron& t : mesh.tetrahedra)
    corners.push_back({t.nodes[0], t.nodes[1], t.nodes[2], t.nodes[3]});
  return corners;
}

Pinches pinches_of(const MeshEntities& mesh) {
  return pinches(adjacency(corners_of(mesh)).boundary);
}

MeshEntities entities_of(const Cells& cells) {
  test::Lattice lattice = test::cubes(cells);
  MeshEntities mesh;
  mesh.nodes = std::move(lattice.nodes);
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    mesh.node_numbers.push_back(static_cast<std::int64_t>(i) + 1);
  for (const Tetrahedron& corners : lattice.tetrahedra) add(mesh, corners);
  return mesh;
}

/// A chain of cubes whose ends meet in an edge, and one whose ends meet in a corner.
const Cells kMeetInAnEdge{{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 1, 0}};
const Cells kMeetInACorner{{1, 1, 1}, {0, 1, 1}, {0, 1, 2}, {0, 1, 3},
                           {1, 1, 3}, {2, 1, 3}, {2, 2, 3}, {2, 2, 2}};

TEST(SeparateSheets, GivesEachSideOfAPinchItsOwnNode) {
  for (const Cells& cells : {kMeetInAnEdge, kMeetInACorner}) {
    MeshEntities mesh = entities_of(cells);
    const Pinches before = pinches_of(mesh);
    ASSERT_EQ(before.edges.size() + before.points, 1U);
    const std::size_t nodes = mesh.nodes.size();
    const std::int32_t hinge =
        node_at(cells == kMeetInAnEdge ? std::array{1, 1, 0} : std::array{2, 2, 2});
    mesh.node_sets["held"] = {hinge};
    std::string log;
    separate_sheets(mesh, "a.msh", [&](std::string_view line) { log += line; });
    EXPECT_TRUE(pinches_of(mesh).nodes.empty());
    EXPECT_EQ(adjacency(corners_of(mesh)).parts, 1);
    ASSERT_EQ(mesh.nodes.size(), nodes + 1);
    EXPECT_EQ(mesh.nodes.back(), mesh.nodes[static_cast<std::size_t>(hinge)]);
    EXPECT_EQ(mesh.node_numbers.back(), mesh.node_numbers[static_cast<std::size_t>(hinge)]);
    EXPECT_EQ(mesh.node_sets.at("held"),
              (std::vector<std::int32_t>{hinge, static_cast<std::int32_t>(nodes)}));
    EXPECT_THAT(log, testing::HasSubstr("separated: 1 node added"));
  }
}

TEST(SeparateSheets, LeavesAManifoldAlone) {
  MeshEntities mesh = entities_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
  const std::size_t nodes = mesh.nodes.size();
  separate_sheets(mesh, "a.msh", [](std::string_view line) { FAIL() << line; });
  EXPECT_EQ(mesh.nodes.size(), nodes);
}

TEST(SeparateSheets, MiddlesOfHalvedEdgesAreInTheSetsOfBothEnds) {
  MeshEntities mesh = entities_of(test::kRingAroundAnEdge);
  const auto [low, high] = test::kEdgeOfTheRing;
  for (ListedTetrahedron& t : mesh.tetrahedra) t.quadratic = true;
  const std::size_t before = mesh.tetrahedra.size();
  mesh.node_sets = {{"both", {low, high}}, {"one", {low}}};
  std::string log;
  separate_sheets(mesh, "a.msh", [&](std::string_view line) { log += line; });
  EXPECT_TRUE(pinches_of(mesh).nodes.empty());
  EXPECT_EQ(mesh.node_numbers.size(), mesh.nodes.size());
  const auto first_new = static_cast<std::int32_t>(mesh.nodes.size() - 2);
  EXPECT_THAT(mesh.node_sets.at("both"), testing::ElementsAre(low, high, first_new, first_new + 1));
  EXPECT_THAT(mesh.node_sets.at("one"), testing::ElementsAre(low));
  // The middle of the file's edge is no middle of its halves: they are linear.
  const auto is_linear = [](const ListedTetrahedron& t) { return !t.quadratic; };
  EXPECT_EQ(std::count_if(mesh.tetrahedra.begin(), mesh.tetrahedra.end(), is_linear),
            2 * (mesh.tetrahedra.size() - before));
  EXPECT_THAT(log, testing::HasSubstr("1 edge halved"));
}

TEST(SeparateSheets, NodesOfFilledTipsAreInTheSetsOfTheNodeBesideThem) {
  MeshEntities mesh = entities_of(test::block_without(4, {{1, 1, 1}, {2, 2, 2}}));
  for (ListedTetrahedron& t : mesh.tetrahedra) t.quadratic = true;
  const std::size_t before = mesh.tetrahedra.size();
  const std::int32_t node = test::node_at({2, 2, 2});
  mesh.node_sets = {{"held", {node}}};
  std::string log;
  separate_sheets(mesh, "a.msh", [&](std::string_view line) { log += line; });
  EXPECT_TRUE(pinches_of(mesh).nodes.empty());
  EXPECT_THAT(mesh.node_sets.at("held"),
              testing::ElementsAre(node, static_cast<std::int32_t>(mesh.nodes.size() - 1)));
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    EXPECT_EQ(mesh.tetrahedra[t].quadratic, t < before);
  EXPECT_THAT(log, testing::HasSubstr("the tip of 1 void"));
}

}  // namespace
}  // namespace palpate::mesher
