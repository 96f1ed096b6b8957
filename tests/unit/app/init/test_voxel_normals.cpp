// SPDX-License-Identifier: AGPL-3.0-or-later
// Bodies of known shape as voxels.
#include "app/init/voxel_normals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <string>

#include "app/init/base.hpp"
#include "app/init/body_file.hpp"
#include "app/init/first_sizes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace palpate::app {
namespace {

using Inside = std::function<bool(const Vec3&)>;

/// About the origin, with voxels of 1 x 1 x `slice` mm.
mesher::LabelImage image_of(const Inside& inside, double half, double slice) {
  mesher::LabelImage image;
  image.step = {Vec3{0.001, 0, 0}, Vec3{0, 0.001, 0}, Vec3{0, 0, 0.001 * slice}};
  image.size = {static_cast<std::size_t>(2000 * half), static_cast<std::size_t>(2000 * half),
                static_cast<std::size_t>(2000 * half / slice)};
  image.origin = {-half, -half, -half};
  for (std::size_t k = 0; k < image.size[2]; ++k)
    for (std::size_t j = 0; j < image.size[1]; ++j)
      for (std::size_t i = 0; i < image.size[0]; ++i)
        image.labels.push_back(inside(image.point({static_cast<double>(i), static_cast<double>(j),
                                                   static_cast<double>(k)}))
                                   ? 1
                                   : 0);
  return image;
}

/// What `init` makes of the file of these voxels.
FirstSizes sizes_of(const Inside& inside, double half, double slice) {
  const mesher::LabelImage image = image_of(inside, half, slice);
  const samples::TemporaryFolder folder;
  const auto path = folder / "body.nrrd";
  {
    std::ofstream file(path, std::ios::binary);
    file << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: " << image.size[0] << " " << image.size[1]
         << " " << image.size[2] << "\nspace: left-posterior-superior\n"
         << "space directions: (1,0,0) (0,1,0) (0,0," << slice
         << ")\nspace origin: (0,0,0)\nspace units: \"mm\" \"mm\" "
         << "\"mm\"\nencoding: raw\n\n";
    for (const std::int32_t label : image.labels) file.put(static_cast<char>(label));
  }
  const BodyFile body = read_body_file(path, "");
  return first_sizes(body.surface, find_base(body.surface), 200, body.inward);
}

TEST(VoxelNormals, OfABallPointToItsCentre) {
  for (const double slice : {1.0, 3.0}) {
    const VoxelNormals normals(
        image_of([](const Vec3& x) { return norm(x) < 0.022; }, 0.027, slice));
    for (int n = 0; n < 60; ++n) {
      const double z = -0.95 + 1.9 * n / 59, around = 2.4 * n;
      const double r = std::sqrt(1 - z * z);
      const Vec3 outward{r * std::cos(around), r * std::sin(around), z};
      EXPECT_GT(-dot(normals.inward(0.022 * outward), outward), std::cos(0.15))
          << slice << " " << n;
    }
  }
}

/// Across their faces, voxels of a ball are 0.71 of its diameter thick in the median.
TEST(FirstSizesOfVoxels, KnowTheDiameterOfABall) {
  for (const double slice : {1.0, 3.0}) {
    const FirstSizes sizes = sizes_of([](const Vec3& x) { return norm(x) < 0.022; }, 0.027, slice);
    EXPECT_NEAR(sizes.thickness, 0.044, 0.03 * 0.044) << slice;
  }
}

/// Across their faces, voxels of a tilted plate are up to 1.7 times as thick as it.
TEST(FirstSizesOfVoxels, KnowTheThicknessOfATiltedPlate) {
  const Vec3 normal{1 / std::sqrt(3.0), 1 / std::sqrt(3.0), 1 / std::sqrt(3.0)};
  const FirstSizes sizes = sizes_of(
      [&](const Vec3& x) { return norm(x) < 0.03 && std::abs(dot(x, normal)) < 0.005; }, 0.032, 1);
  EXPECT_NEAR(sizes.thickness, 0.010, 0.001);
}

}  // namespace
}  // namespace palpate::app
