// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesher/geometry/faulty_faces.hpp"
#include "tests/unit/mesher/repair/soups.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

using testing::Contains;
using testing::Each;
using testing::HasSubstr;

constexpr double kExtent = 0.12;  // m

Surface large() {
  return test::box({0, 0, 0}, {0.05, 0.05, 0.05});
}

/// The volume that is left of these surfaces.
double kept_volume(Surface surface, const RepairSettings& settings, Steps& steps) {
  keep_parts(surface, settings, kExtent, "body.stl", steps);
  return signed_volume(surface);
}

TEST(Parts, TheFractionOfTheLargestIsOfTheArea) {
  const Surface second = test::box({0.08, 0, 0}, {0.13, 0.05, 0.05});
  const Surface third = test::box({0.16, 0, 0}, {0.21, 0.05, 0.05});
  EXPECT_NEAR(largest_fraction(test::joined(large(), test::joined(second, third))), 1.0 / 3, 1e-12);
  EXPECT_EQ(largest_fraction({}), 0);
}

TEST(Parts, OfSmallExtentAreRemoved) {
  const Surface speck = test::box({0.1, 0, 0}, {0.104, 0.004, 0.004});
  Steps steps;
  EXPECT_NEAR(kept_volume(test::joined(speck, large()), {}, steps), 1.25e-4, 1e-16);
  EXPECT_THAT(steps, Contains(HasSubstr("removed 1 separate part, the largest of 4 mm")));
}

TEST(Parts, OfLittleAreaAreRemoved) {
  // A hair: 100 mm long, 16 mm^2 of area against 15000 mm^2.
  const Surface hair = test::box({0.06, 0, 0}, {0.06004, 0.00004, 0.1});
  Steps steps;
  EXPECT_NEAR(kept_volume(test::joined(large(), hair), {}, steps), 1.25e-4, 1e-16);
}

TEST(Parts, OnRequestOnlyTheLargestIsKept) {
  RepairSettings settings;
  settings.largest_part = true;
  const Surface second = test::box({0.08, 0, 0}, {0.12, 0.04, 0.04});
  Steps steps;
  EXPECT_NEAR(kept_volume(test::joined(second, large()), settings, steps), 1.25e-4, 1e-16);
}

TEST(Parts, OfComparableSizeAreRefusedWithTheirSizesAndFaces) {
  const Surface open = test::without(test::box({0.08, 0, 0}, {0.12, 0.04, 0.04}),
                                     [](const Vec3& x) { return x[2] > 0.03; });
  ASSERT_EQ(open.triangles.size(), 10U);
  Steps steps;
  try {
    kept_volume(test::joined(open, large()), {}, steps);
    FAIL() << "accepted";
  } catch (const FaultySurface& fault) {
    EXPECT_THAT(fault.problem(),
                HasSubstr("2 separate parts, the largest first: (0, 0, 0) mm to (50, 50, 50) mm, "
                          "15000 mm^2, 125000 mm^3; (80, 0, 0) mm to (120, 40, 40) mm, 8000 mm^2, "
                          "open"));
    EXPECT_THAT(fault.remedy(), HasSubstr("surface.parts = \"largest\""));
    EXPECT_EQ(fault.faces().faults.size(), 10U);
    EXPECT_THAT(fault.faces().faults, Each(Fault::SeparatePart));
    for (const Vec3& x : fault.faces().points) EXPECT_GE(x[0], 0.08);
  }
}

}  // namespace
}  // namespace palpate::mesher
