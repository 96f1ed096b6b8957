// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/mesh/read_volume_mesh.hpp"

#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;

TEST(ReadVolumeMesh, GroupsGetTheRegionsOfTheCase) {
  const VolumeMesh mesh =
      read_volume_mesh({test::mesh_file("gmsh/body_41.msh"),
                        1e-3,
                        "",
                        {{"left half", "tissue"}, {"right half", "tissue"}, {"nodule", "stiff"}}},
                       {});
  EXPECT_THAT(mesh.region_names, testing::UnorderedElementsAre("tissue", "stiff"));
  EXPECT_EQ(test::region_sizes(mesh).at("tissue").tetrahedra, 535U);
  // The groups of the file stay sets of nodes.
  EXPECT_EQ(test::heights(mesh, "nodule"), std::pair(6.0, 18.0));
  EXPECT_TRUE(mesh.node_sets.contains("tissue"));
}

TEST(ReadVolumeMesh, RefusesAGroupThatTheFileDoesNotHave) {
  expect_refusal(
      [] {
        read_volume_mesh({test::mesh_file("gmsh/body_41.msh"), 1e-3, "", {{"lung", "a"}}}, {});
      },
      "body_41.msh", "the group 'lung'", "'left half', 'nodule', 'right half'");
}

TEST(ReadVolumeMesh, RefusesFilesOfAnotherKindAndAnotherUnit) {
  expect_refusal([] { test::read_file("README.md"); }, "README.md",
                 "unknown kind of volume mesh '.md'", "convert");
  expect_refusal([] { test::read_file("nowhere.msh"); }, "nowhere.msh", "no such file");
  expect_refusal([] { test::read_file("gmsh/body_41.msh", 1); }, "body_41.msh", "40000 mm",
                 "looks likely");
}

}  // namespace
}  // namespace palpate::mesher
