// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/read/image/image_field.hpp"

#include "tests/unit/mesher/read/mesh_files.hpp"

namespace palpate::mesher {
namespace {

using test::expect_refusal;
using test::mesh_file;

TEST(ImageField, LabelsGetTheRegionsOfTheCase) {
  std::string log;
  const LabelField field =
      image_field({mesh_file("images/ball_sform.nii.gz"), 0, {{5, "stiff"}, {1, "soft"}}},
                  [&](std::string_view line) { log += line; });
  EXPECT_EQ(field.region_names, (std::vector<std::string>{"stiff", "soft"}));
  EXPECT_NEAR(field.resolution, 1.5e-3, 1e-8);
  const Vec3 centre{14.3953653e-3, -7.28462529e-3, 20e-3};
  EXPECT_EQ(field.region(centre), 0);
  EXPECT_EQ(field.region(centre + Vec3{0, 0, 5e-3}), 1);
  EXPECT_EQ(field.region(centre + Vec3{0, 0, 9.9e-3}), kVoid);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_LT(field.box.low[axis], centre[axis] - 7e-3);
    EXPECT_GT(field.box.high[axis], centre[axis] + 7e-3);
  }
  EXPECT_EQ(log.find("no part of the body"), std::string::npos);
}

TEST(ImageField, OtherLabelsAreNoPartOfTheBody) {
  std::string log;
  const LabelField field = image_field({mesh_file("images/ball_sform.nii.gz"), 0, {{1, "soft"}}},
                                       [&](std::string_view line) { log += line; });
  EXPECT_EQ(field.region({14.3953653e-3, -7.28462529e-3, 20e-3}), kVoid);
  EXPECT_THAT(log, testing::HasSubstr("no part of the body: labels 5 (17 voxels)"));
}

TEST(ImageField, RefusesLabelsThatNoVoxelHas) {
  expect_refusal(
      [] {
        image_field({mesh_file("images/ball_sform.nii.gz"), 0, {{2, "a"}}}, {});
      },
      "ball_sform.nii.gz", "no voxel has the label 2", "1 (246 voxels), 5 (17 voxels)");
}

}  // namespace
}  // namespace palpate::mesher
