// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/crossings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "mesher/geometry/queries.hpp"
#include "mesher/repair/soundness.hpp"
#include "tests/unit/mesher/repair/soups.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kRadius = 0.03;  // m

TEST(Crossings, OfABallAreNone) {
  Surface ball = test::sphere({0, 0, 0}, kRadius, 16);
  Steps steps;
  EXPECT_TRUE(remove_crossings(ball, steps));
  EXPECT_THAT(steps, IsEmpty());
}

TEST(Crossings, OfAFoldAreRemoved) {
  // Two neighbouring points of the equator change places.
  Surface folded = test::sphere({0, 0, 0}, kRadius, 64);
  std::size_t first = 0;
  while (std::abs(folded.points[first][2]) > 1e-9) ++first;
  std::swap(folded.points[first], folded.points[first + 1]);
  ASSERT_GT(count_self_intersections(folded), 0U);
  Steps steps;
  EXPECT_TRUE(remove_crossings(folded, steps));
  EXPECT_EQ(count_self_intersections(folded), 0U);
  EXPECT_THAT(steps, ElementsAre(HasSubstr("of faces")));
  // The fold is narrower than 1/1000 of the volume.
  const double volume = signed_volume(test::sphere({0, 0, 0}, kRadius, 64));
  EXPECT_NEAR(signed_volume(folded) / volume, 1, 1e-3);
}

TEST(Crossings, OfTwoBallsThatOverlapAreLeftWhereTheyAreMany) {
  Surface balls = test::joined(test::sphere({0, 0, 0}, kRadius, 96),
                               test::sphere({kRadius, 0.1 * kRadius, 0}, kRadius, 96));
  ASSERT_GT(count_self_intersections(balls), 200U);
  const std::vector<Triangle> triangles = balls.triangles;
  Steps steps;
  EXPECT_FALSE(remove_crossings(balls, steps));
  EXPECT_EQ(balls.triangles, triangles);
  EXPECT_THAT(steps, IsEmpty());
}

TEST(DegenerateFaces, AreRemoved) {
  Surface cube = test::with_a_face_of_no_area(test::box({0, 0, 0}, {0.05, 0.05, 0.05}));
  ASSERT_EQ(count_degenerate_triangles(cube), 1U);
  Steps steps;
  remove_degenerate_faces(cube, steps);
  EXPECT_THAT(steps, ElementsAre("removed faces of zero area"));
  EXPECT_TRUE(is_sound(test::soup_of(cube)));
  EXPECT_NEAR(signed_volume(cube), 1.25e-4, 1e-16);
}

}  // namespace
}  // namespace palpate::mesher
