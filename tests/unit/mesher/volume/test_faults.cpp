// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/volume/faults.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/mesher/lattice.hpp"

namespace palpate::mesher {
namespace {

VolumeMesh mesh_of(const test::Cells& cells) {
  const test::Lattice lattice = test::cubes(cells);
  VolumeMesh mesh;
  mesh.nodes = lattice.nodes;
  mesh.tetrahedra = lattice.tetrahedra;
  mesh.region.assign(mesh.tetrahedra.size(), 0);
  return mesh;
}

const FaultLimits kLimits{175, [](const Vec3&) { return 0.1; }};

TEST(Faults, ABlockHasNone) {
  const Faults found =
      find_faults(mesh_of({{0, 0, 0}, {1, 0, 0}}), {{{2, 0.5, 0.5}}, {{0.3, 1.05, 0.2}}}, kLimits);
  EXPECT_TRUE(found.pinches.empty());
  EXPECT_TRUE(found.islands.empty());
  EXPECT_TRUE(found.flat.empty());
  EXPECT_TRUE(found.lost.empty());
}

TEST(Faults, PinchesAreTheEndsOfTheEdgeInWhichABodyMeetsItself) {
  const VolumeMesh ring = mesh_of(test::kRingAroundAnEdge);
  EXPECT_THAT(find_faults(ring, {}, kLimits).pinches,
              testing::UnorderedElementsAre(Vec3{1, 1, 1}, Vec3{1, 1, 2}));
}

TEST(Faults, IslandsAreTheMiddlesOfTheSmallerPart) {
  const Faults found = find_faults(mesh_of({{0, 0, 0}, {1, 0, 0}, {3, 3, 3}}), {}, kLimits);
  ASSERT_EQ(found.islands.size(), 6U);
  for (const Vec3& x : found.islands)
    for (const double c : x) EXPECT_TRUE(c > 3 && c < 4);
}

TEST(Faults, FlatTetrahedraAndLostPointsHaveAPlace) {
  VolumeMesh mesh;
  mesh.nodes = {{0, 0, 0}, {2, 0, 0}, {1, 2, 0}, {1, 0.7, 0.01}};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  mesh.region = {0};
  const Vec3 far{1, 0.7, 0.2};
  const Faults found = find_faults(mesh, {{far}, {{1, 0.7, 0.05}}}, kLimits);
  EXPECT_THAT(found.flat, testing::ElementsAre(Vec3{1, 0.675, 0.0025}));
  EXPECT_THAT(found.lost, testing::ElementsAre(far));
}

}  // namespace
}  // namespace palpate::mesher
