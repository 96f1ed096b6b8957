// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/change.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/mesher/repair/soups.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

TEST(Change, BetweenASurfaceAndItselfIsNone) {
  const Surface ball = test::sphere({0, 0, 0}, 0.03, 16);
  const Change change = change_between(ball, ball, 1e-9);
  EXPECT_LT(change.distance, 1e-17);
  EXPECT_EQ(change.far_fraction(), 0);
  EXPECT_NEAR(change.area, area(ball), 1e-15);
}

TEST(Change, OfABoxThatGrewOnOneSideIsThatOfItsFarEnd) {
  const Surface before = test::box({0, 0, 0}, {0.05, 0.05, 0.05});
  const Surface after = test::box({0, 0, 0}, {0.05, 0.05, 0.08});
  const Change added = change_between(after, before, 0.025);
  EXPECT_NEAR(added.distance, 0.03, 1e-15);
  EXPECT_NEAR(added.at[2], 0.08, 1e-15);
  // The lid, 2500 of the 21000 mm^2, lies 30 mm away, the middles of the sides 10 to 20 mm less.
  EXPECT_NEAR(added.far_fraction(), 2500.0 / 21000, 1e-12);
  EXPECT_EQ(added.far_faces.faults.size(), 2U);
  EXPECT_THAT(added.far_faces.faults, testing::Each(Fault::Moved));
  // No point of the smaller box is far from the larger one but those of its lid.
  const Change moved = change_between(before, after, 0.025);
  EXPECT_LE(moved.distance, 0.03);
}

TEST(Names, AreThoseOfTheNearestTriangle) {
  const Surface before = test::box({0, 0, 0}, {0.05, 0.05, 0.05});
  std::vector<std::size_t> names;
  for (const Triangle& t : before.triangles)
    names.push_back(area_vector(before.points, t)[2] > 0 ? 1 : 0);  // the lid
  Surface finer = test::box({0, 0, 0.02}, {0.05, 0.05, 0.0501});
  hand_on_names(finer, before, names);
  ASSERT_EQ(finer.names.size(), finer.triangles.size());
  for (std::size_t t = 0; t < finer.triangles.size(); ++t) {
    const Vec3 normal = area_vector(finer.points, finer.triangles[t]);
    if (normal[2] > 0) {
      EXPECT_EQ(finer.names[t], 1U);
    } else {
      EXPECT_EQ(finer.names[t], 0U);
    }
  }
}

}  // namespace
}  // namespace palpate::mesher
