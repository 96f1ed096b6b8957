// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/size_of_body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "format/error.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

mesher::Settings surface(const std::string& file, double unit) {
  mesher::Settings settings;
  settings.surface.path = file;
  settings.surface.unit = unit;
  return settings;
}

/// A tetrahedron with legs of 1, 2 and 3, and a point that belongs to no face.
const char* kTetrahedron =
    "OFF\n5 4 0\n0 0 0\n1 0 0\n0 2 0\n0 0 3\n50 50 50\n"
    "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

TEST(SizeOfBody, IsTheBoxAroundTheFacesInMetres) {
  const samples::TemporaryFolder folder;
  std::ofstream(folder / "body.off") << kTetrahedron;
  const BodySize size = size_of_body(surface("body.off", 0.01), folder.path());
  EXPECT_DOUBLE_EQ(size.diagonal, 0.01 * std::sqrt(14.0));
  EXPECT_DOUBLE_EQ(size.thickness, 0.01);
}

/// The box of radius 10 around the ball that test_read_gmsh.cpp and test_label_image.cpp read.
TEST(SizeOfBody, IsTheSameForMeshAndImageOfOneBall) {
  const auto folder = test::source_folder() / "tests/data/meshes";
  mesher::Settings mesh, image;
  mesh.volume_mesh.path = "gmsh/ball_41.msh";
  mesh.volume_mesh.unit = 1e-3;
  const BodySize of_mesh = size_of_body(mesh, folder);
  EXPECT_NEAR(of_mesh.diagonal / of_mesh.thickness, std::sqrt(3.0), 0.05);
  image.image.path = "images/ball_raw.nhdr";
  image.image.unit = 1e-3;
  image.image.labels = {{1, "matrix"}, {2, "core"}};
  const BodySize of_image = size_of_body(image, folder);
  EXPECT_GT(of_image.thickness, 0);
  EXPECT_GE(of_image.diagonal, of_image.thickness * std::sqrt(3.0) * (1 - 1e-9));
  image.image.labels = {{77, "nowhere"}};
  EXPECT_THROW(size_of_body(image, folder), Error);
}

TEST(SizeOfBody, RefusesWhatHasNoExtent) {
  const samples::TemporaryFolder folder;
  std::ofstream(folder / "flat.off") << "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_THROW(size_of_body(surface("flat.off", 1), folder.path()), Error);
  EXPECT_THROW(size_of_body(surface("none.off", 1), folder.path()), Error);
}

}  // namespace
}  // namespace palpate::app
