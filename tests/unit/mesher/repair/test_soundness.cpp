// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/repair/soundness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "tests/unit/mesher/repair/soups.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

using test::soup_of;

Surface cube(const Vec3& low = {0, 0, 0}) {
  return test::box(low, low + Vec3{0.05, 0.05, 0.05});
}

TEST(Soundness, OfClosedSurfacesIsRecognizedWhateverTheirOrientation) {
  EXPECT_TRUE(is_sound(soup_of(cube())));
  EXPECT_TRUE(is_sound(soup_of(test::sphere({0, 0, 0}, 0.03, 32))));
  Soup turned = soup_of(cube());
  for (std::size_t p = 0; p < turned.polygons.size(); p += 3)
    std::swap(turned.polygons[p][0], turned.polygons[p][1]);
  EXPECT_TRUE(is_sound(turned));
}

TEST(Soundness, OfASurfaceWithAHoleIsNone) {
  Soup soup = soup_of(cube());
  soup.polygons.pop_back();
  EXPECT_FALSE(is_sound(soup));
}

TEST(Soundness, OfAnEdgeWithFourFacesIsNone) {
  // Two cubes that share an edge.
  Soup soup = soup_of(test::joined(cube(), cube({0.05, 0.05, 0})));
  for (std::size_t v = 8; v < soup.points.size(); ++v)
    for (std::size_t u = 0; u < 8; ++u)
      if (norm(soup.points[v] - soup.points[u]) < 1e-12)
        for (auto& corners : soup.polygons) std::replace(corners.begin(), corners.end(), v, u);
  EXPECT_FALSE(is_sound(soup));
}

TEST(Soundness, OfTwoPartsIsNone) {
  EXPECT_FALSE(is_sound(soup_of(test::joined(cube(), cube({0.1, 0, 0})))));
}

TEST(Soundness, OfATriangleOfZeroAreaIsNone) {
  EXPECT_FALSE(is_sound(soup_of(test::with_a_face_of_no_area(cube()))));
}

TEST(Soundness, OfASurfaceThatCrossesItselfIsNone) {
  Surface pierced = test::sphere({0, 0, 0}, 0.03, 32);
  pierced.points[0] = -2.0 * pierced.points[0];  // through the far side
  EXPECT_FALSE(is_sound(soup_of(pierced)));
}

}  // namespace
}  // namespace palpate::mesher
