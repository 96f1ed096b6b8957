// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "format/to_index.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

double largest(const ColouredSurface& surface) {
  return *std::max_element(surface.distance.begin(), surface.distance.end());
}

TEST(Picture, ConcentricSpheresAreTheDifferenceOfTheirRadiiApart) {
  const Surface inner = test::sphere({0, 0, 0}, 0.02, 40),
                outer = test::sphere({0, 0, 0}, 0.021, 40);
  const RepairPicture picture = picture_of_repair(inner, outer, 100);
  // The sides of the polyhedra lie inside the spheres, by less than a hundredth of the radius.
  for (const double distance : picture.file.distance) EXPECT_NEAR(distance, 0.001, 0.0002);
  for (const double distance : picture.repaired.distance) EXPECT_NEAR(distance, 0.001, 1e-5);
}

TEST(Picture, MergedPointsHaveTheLargestDistanceOfTheirCell) {
  const Surface sphere = test::sphere({0, 0, 0}, 0.02, 40);
  Surface dented = sphere;
  dented.points[7] = 0.5 * dented.points[7];
  const RepairPicture picture = picture_of_repair(dented, sphere, 16);
  EXPECT_LT(picture.file.points.size(), sphere.points.size());
  EXPECT_LT(picture.file.triangles.size(), sphere.triangles.size());
  EXPECT_GT(picture.file.triangles.size(), 200U);
  EXPECT_NEAR(largest(picture.file), 0.01, 0.0005);
  for (const Triangle& t : picture.file.triangles) EXPECT_TRUE(t[0] != t[1] && t[1] != t[2]);
}

TEST(Picture, PatchesOfHolesAreFarFromTheFile) {
  const Surface closed = test::box({0, 0, 0}, {0.04, 0.04, 0.04});
  Surface open = closed;
  std::erase_if(open.triangles, [&](const Triangle& t) {  // the top
    return std::all_of(t.begin(), t.end(), [&](auto v) { return open.points[to_index(v)][2] > 0; });
  });
  ASSERT_EQ(open.triangles.size(), 10U);
  const RepairPicture picture = picture_of_repair(open, closed, 64);
  EXPECT_LT(largest(picture.file), 1e-12);
  // A face without its triangles has points in its middle, half a side from those that are left.
  EXPECT_NEAR(largest(picture.repaired), 0.02, 0.002);
}

}  // namespace
}  // namespace palpate::mesher
