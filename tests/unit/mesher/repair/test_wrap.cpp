// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/wrap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesher/repair/soundness.hpp"
#include "tests/unit/mesher/repair/soups.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

constexpr double kRadius = 0.03;  // m

TEST(AlphaWrap, OfABallWithACrackIsClosedAndNearItsVolume) {
  const Surface ball = test::sphere({0, 0, 0}, kRadius, 32);
  Surface cracked = ball;
  cracked.triangles.resize(cracked.triangles.size() - 3);
  const double alpha = kRadius / 10, offset = kRadius / 300;
  const Surface wrap = alpha_wrap(cracked, alpha, offset);
  EXPECT_TRUE(is_sound(test::soup_of(wrap)));
  const double exact = 4 * std::numbers::pi / 3 * std::pow(kRadius, 3);
  EXPECT_GT(signed_volume(wrap), 0.98 * signed_volume(ball));
  EXPECT_LT(signed_volume(wrap), std::pow(1 + 2 * offset / kRadius, 3) * exact);
}

TEST(AlphaWrap, OfASheetIsASkinAboutTwoOffsetsThick) {
  Surface sheet;
  sheet.points = {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  const double offset = 0.0002;
  const double thickness = mean_thickness(alpha_wrap(sheet, 0.005, offset));
  EXPECT_GT(thickness, offset);
  EXPECT_LT(thickness, 3 * offset);
}

}  // namespace
}  // namespace palpate::mesher
