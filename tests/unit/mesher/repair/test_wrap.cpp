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
  Soup soup = test::soup_of(ball);
  soup.polygons.resize(soup.polygons.size() - 3);
  const double alpha = kRadius / 10, offset = kRadius / 300;
  const Surface wrap = alpha_wrap(soup, alpha, offset);
  EXPECT_TRUE(is_sound(test::soup_of(wrap)));
  const double exact = 4 * std::numbers::pi / 3 * std::pow(kRadius, 3);
  EXPECT_GT(signed_volume(wrap), 0.98 * signed_volume(ball));
  EXPECT_LT(signed_volume(wrap), std::pow(1 + 2 * offset / kRadius, 3) * exact);
}

TEST(AlphaWrap, OfASoupAndOfASurfaceAreTheSame) {
  const Surface cube = test::box({0, 0, 0}, {0.05, 0.05, 0.05});
  const Surface of_surface = alpha_wrap(cube, 0.005, 0.0002);
  const Surface of_soup = alpha_wrap(test::soup_of(cube), 0.005, 0.0002);
  EXPECT_EQ(of_surface.points, of_soup.points);
  EXPECT_EQ(of_surface.triangles, of_soup.triangles);
}

TEST(MeanThickness, OfAPlateIsItsThicknessButForTheRim) {
  // 2 V / A of a x a x t is t / (1 + 2 t / a).
  EXPECT_NEAR(mean_thickness(test::box({0, 0, 0}, {0.1, 0.1, 0.001})), 0.001 / 1.02, 1e-12);
  EXPECT_EQ(mean_thickness({}), 0);
}

TEST(MeanThickness, OfTheWrapOfASheetIsThatOfItsSkin) {
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
