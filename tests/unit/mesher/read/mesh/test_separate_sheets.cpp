// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/mesh/separate_sheets.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "mesher/volume/boundary.hpp"

namespace palpate::mesher {
namespace {

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

constexpr int kSide = 5;

std::int32_t node_at(const std::array<int, 3>& at) {
  return at[0] + kSide * (at[1] + kSide * at[2]);
}

/// Unit cubes of a lattice of 5 x 5 x 5 points, in six tetrahedra each (Kuhn).
MeshEntities cubes(const std::vector<std::array<int, 3>>& cells) {
  MeshEntities mesh;
  for (int k = 0; k < kSide; ++k)
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i) {
        mesh.node_numbers.push_back(static_cast<std::int64_t>(mesh.nodes.size()) + 1);
        mesh.nodes.push_back({1.0 * i, 1.0 * j, 1.0 * k});
      }
  constexpr std::array<std::array<int, 3>, 6> kOrders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  for (const std::array<int, 3>& cell : cells)
    for (std::size_t order = 0; order < kOrders.size(); ++order) {
      std::array<int, 3> at = cell;
      Tetrahedron t{};
      for (std::size_t corner = 0;; ++corner) {
        t[corner] = node_at(at);
        if (corner == 3) break;
        ++at[static_cast<std::size_t>(kOrders[order][corner])];
      }
      if (order > 2) std::swap(t[1], t[2]);  // odd orders turn the other way
      add(mesh, t);
    }
  return mesh;
}

using Cells = std::vector<std::array<int, 3>>;

/// A chain of cubes whose ends meet in an edge, and one whose ends meet in a corner.
const Cells kMeetInAnEdge{{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 1, 0}};
const Cells kMeetInACorner{{1, 1, 1}, {0, 1, 1}, {0, 1, 2}, {0, 1, 3},
                           {1, 1, 3}, {2, 1, 3}, {2, 2, 3}, {2, 2, 2}};

TEST(SeparateSheets, GivesEachSideOfAPinchItsOwnNode) {
  for (const Cells& cells : {kMeetInAnEdge, kMeetInACorner}) {
    MeshEntities mesh = cubes(cells);
    const Pinches before = pinches_of(mesh);
    ASSERT_EQ(before.edges + before.points, 1U);
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
  MeshEntities mesh = cubes({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
  const std::size_t nodes = mesh.nodes.size();
  separate_sheets(mesh, "a.msh", [](std::string_view line) { FAIL() << line; });
  EXPECT_EQ(mesh.nodes.size(), nodes);
}

}  // namespace
}  // namespace palpate::mesher
