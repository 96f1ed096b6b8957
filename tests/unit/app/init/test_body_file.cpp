// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/init/body_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "format/error.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

BodyFile read(const std::string& file, const std::string& unit = "") {
  return read_body_file(test::source_folder() / file, unit);
}

TEST(BodyFile, OfASurfaceHasTheUnitThatTheFileStatesOrTheUserGives) {
  const BodyFile organ = read("data/bodies/organ.off");
  EXPECT_EQ(organ.kind, BodyKind::Surface);
  EXPECT_EQ(organ.unit_source, UnitSource::Stated);
  EXPECT_NEAR(mesher::largest_dimension(organ.surface.points), 0.189, 1e-3);
  const BodyFile liver = read("data/bodies/sofa/liver.obj");
  EXPECT_EQ(liver.unit_source, UnitSource::Guessed);
  EXPECT_EQ(liver.unit.symbol, "dm");
  const BodyFile given = read("data/bodies/sofa/liver.obj", "cm");
  EXPECT_EQ(given.unit_source, UnitSource::Given);
  EXPECT_NEAR(mesher::largest_dimension(given.surface.points),
              mesher::largest_dimension(liver.surface.points) / 10, 1e-9);
  EXPECT_THROW(read("data/bodies/organ.off", "feet"), Error);
}

TEST(BodyFile, TellsRepairsAndParts) {
  EXPECT_FALSE(read("data/bodies/organ.off").was_repaired);
  EXPECT_TRUE(read("tests/data/surfaces/sofa/head.obj").was_repaired);
  EXPECT_TRUE(read("tests/data/surfaces/surfice/cortex_5124.obj").has_parts);
  EXPECT_THROW(read("tests/data/surfaces/trimesh/empty.stl"), Error);
}

// tests/data/meshes/gmsh/ball.geo: a ball of radius 20 mm with a core of 8 mm.
TEST(BodyFile, OfAVolumeMeshHasItsBoundaryAndRegions) {
  const BodyFile body = read("tests/data/meshes/gmsh/body_41.msh");
  EXPECT_EQ(body.kind, BodyKind::VolumeMesh);
  EXPECT_FALSE(body.regions.empty());
  EXPECT_GT(mesher::signed_volume(body.surface), 0);
  EXPECT_EQ(read("tests/data/meshes/vtk/box_4.vtk").kind, BodyKind::Surface);
}

/// Two tetrahedra, 1.3 units apart: in micrometres their size would be a fault, too.
TEST(BodyFile, NamesTheFaultOfAVolumeMeshInAUnitThatFits) {
  const samples::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "two.node";
  std::ofstream(file) << "8 3 0 0\n1 0 0 0\n2 .3 0 0\n3 0 .3 0\n4 0 0 .3\n"
                         "5 1 0 0\n6 1.3 0 0\n7 1 .3 0\n8 1 0 .3\n";
  std::ofstream(folder.path() / "two.ele") << "2 4 0\n1 1 2 3 4\n2 5 6 7 8\n";
  try {
    read_body_file(file, "");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.problem(), testing::HasSubstr("2 parts"));
  }
}

TEST(BodyFile, OfASegmentationHasTheFacesOfItsVoxels) {
  const BodyFile ball = read("tests/data/meshes/images/ball_sform.nii.gz");
  EXPECT_EQ(ball.kind, BodyKind::Image);
  EXPECT_EQ(ball.unit_source, UnitSource::Stated);
  EXPECT_FALSE(ball.labels.empty());
  // The area of a ball of the same volume; a few voxels across, steps make it rough.
  const double volume = mesher::signed_volume(ball.surface);
  const double area = mesher::area(ball.surface) / ball.area_excess;
  EXPECT_NEAR(area, std::cbrt(36 * std::numbers::pi * volume * volume), 0.06 * area);
}

}  // namespace
}  // namespace palpate::app
