// SPDX-License-Identifier: AGPL-3.0-or-later
#include "format/vec3.hpp"

#include <gtest/gtest.h>

#include <cstddef>

#include "format/numbers.hpp"

namespace palpate {
namespace {

TEST(Vec3, AddsSubtractsAndScalesByComponents) {
  EXPECT_EQ((Vec3{1, 2, 3} + Vec3{10, 20, 30}), (Vec3{11, 22, 33}));
  EXPECT_EQ((Vec3{1, 2, 3} - Vec3{10, 20, 30}), (Vec3{-9, -18, -27}));
  EXPECT_EQ((-Vec3{1, -2, 3}), (Vec3{-1, 2, -3}));
  EXPECT_EQ((2.0 * Vec3{1, 2, 3}), (Vec3{2, 4, 6}));
}

TEST(Vec3, MultipliesByTheRightHandRule) {
  EXPECT_EQ(dot({1, 2, 3}, {4, -5, 6}), 12);
  EXPECT_EQ(cross({1, 0, 0}, {0, 1, 0}), (Vec3{0, 0, 1}));
  const Vec3 a{1, 2, 3}, b{-2, 0.5, 4};
  EXPECT_NEAR(dot(cross(a, b), a), 0, 1e-15);
  EXPECT_NEAR(dot(cross(a, b), b), 0, 1e-15);
  EXPECT_EQ(norm({2, 3, 6}), 7);
}

TEST(Vec3, IsFiniteInEveryComponent) {
  EXPECT_TRUE(is_finite({1e300, -1, 0}));
  for (std::size_t i = 0; i < 3; ++i)
    for (const double bad : {kInfinity, -kInfinity, kUnknown}) {
      Vec3 a{1, 2, 3};
      a[i] = bad;
      EXPECT_FALSE(is_finite(a));
    }
}

}  // namespace
}  // namespace palpate
