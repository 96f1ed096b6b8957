// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/init/check_surface.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "tests/support/source_folder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

using testing::Contains;
using testing::HasSubstr;

SurfaceCheck check(const std::string& file, const std::string& unit = "", bool largest = false) {
  return check_surface(test::source_folder() / file, unit, largest);
}

TEST(CheckSurface, OfASoundBodyFindsNothing) {
  const SurfaceCheck found = check("data/bodies/sofa/liver.obj");
  EXPECT_TRUE(found.is_sound());
  EXPECT_EQ(found.file.unit.symbol, "dm");
  EXPECT_TRUE(found.faulty.faults.empty());
}

// The numbers of edges are those that test_real_surfaces.cpp expects of a refusal.
TEST(CheckSurface, CountsTheFaultsOfTheHeadAndStatesItsRepair) {
  const SurfaceCheck head = check("tests/data/surfaces/sofa/head.obj", "cm");
  EXPECT_FALSE(head.is_sound());
  EXPECT_FALSE(head.refusal);
  EXPECT_THAT(head.faults, Contains(HasSubstr("40 border edges")));
  EXPECT_THAT(head.repairs, Contains(HasSubstr("filled ")));
  EXPECT_THAT(head.repairs, Contains(HasSubstr("the surface moved by at most")));
  EXPECT_THAT(head.faulty.faults, Contains(mesher::Fault::BorderEdge));
}

TEST(CheckSurface, NamesTheRefusalOfPartsUnlessTheLargestIsTaken) {
  const std::string cortex = "tests/data/surfaces/surfice/cortex_5124.obj";
  const SurfaceCheck both = check(cortex, "mm");
  ASSERT_TRUE(both.refusal);
  EXPECT_THAT(both.refusal->problem(), HasSubstr("2 separate parts"));
  EXPECT_THAT(both.faults, Contains(HasSubstr("2 separate parts")));
  EXPECT_FALSE(check(cortex, "mm", true).refusal);
}

TEST(CheckSurface, RefusesWhatHasNoFaces) {
  EXPECT_THROW(check("tests/data/surfaces/trimesh/empty.stl", "mm"), Error);
}

TEST(PlyText, OfARepairedSurfaceIsReadBackAsSound) {
  const SurfaceCheck head = check("tests/data/surfaces/sofa/head.obj", "cm");
  const samples::TemporaryFolder folder;
  std::ofstream(folder / "repaired.ply") << ply_text(head.file.surface, head.file.unit.si);
  const SurfaceCheck again = check_surface(folder / "repaired.ply", "cm", false);
  EXPECT_TRUE(again.is_sound());
  EXPECT_NEAR(mesher::signed_volume(again.file.surface), mesher::signed_volume(head.file.surface),
              1e-9 * mesher::signed_volume(head.file.surface));
}

}  // namespace
}  // namespace palpate::app
