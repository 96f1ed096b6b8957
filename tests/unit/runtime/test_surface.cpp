// SPDX-License-Identifier: AGPL-3.0-or-later
// The response surface: who is next to whom, what is active, and what is refused at load.
#include "runtime/surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "format/error.hpp"
#include "tests/support/bodies.hpp"

namespace palpate::test {
namespace {

using runtime::Element;
using runtime::kNoElement;
using runtime::Surface;

TEST(Surface, NaturalCoordinatesHaveTheirGradients) {
  const Surface surface(bumpy_sphere(2, 0.03, 0.2, uniform));
  for (std::int32_t m = 0; m < surface.element_count(); ++m) {
    const Element& e = surface.element(m);
    EXPECT_NEAR(norm(e.gradient[0] + e.gradient[1] + e.gradient[2]), 0, 1e-9);
    for (std::size_t l = 0; l < 3; ++l) {
      for (std::size_t j = 0; j < 3; ++j) {  // n_l is 1 at vertex l and 0 at the others
        const double n = 1 + dot(e.gradient[l], surface.vertex(e, j) - surface.vertex(e, l));
        EXPECT_NEAR(n, l == j ? 1 : 0, 1e-12);
      }
    }
    const Vec3 centre = surface.position({m, {1.0 / 3, 1.0 / 3, 1.0 / 3}});
    EXPECT_LT(dot(e.facet_normal, centre), 0);  // star-shaped about the origin: inward
    EXPECT_GT(surface.outside_distance(e, 1.01 * centre), 0);
  }
}

TEST(Surface, AClosedBodyHasNoBorderAndNeighboursAreMutual) {
  const Surface surface(sphere(2, 0.03, uniform));
  for (std::int32_t m = 0; m < surface.element_count(); ++m) {
    for (const std::int32_t next : surface.element(m).neighbour) {
      ASSERT_NE(next, kNoElement);
      const auto& back = surface.element(next).neighbour;
      EXPECT_EQ(std::count(back.begin(), back.end(), m), 1);
    }
  }
}

TEST(Surface, AnOpenPlateHasItsRimAsBorder) {
  const Surface surface(plate(5, 0.05, uniform));
  int border = 0;
  for (std::int32_t m = 0; m < surface.element_count(); ++m) {
    const auto& next = surface.element(m).neighbour;
    border += static_cast<int>(std::count(next.begin(), next.end(), kNoElement));
  }
  EXPECT_EQ(border, 4 * 5);
}

TEST(Surface, AHoleDeactivatesItsTrianglesAndBecomesABorder) {
  Library library = plate(4, 0.04, uniform);
  const std::size_t hole = 12;  // the middle vertex, six triangles
  library.responses[hole] = {};
  const Surface surface(library);
  int inactive = 0;
  for (std::int32_t m = 0; m < surface.element_count(); ++m) {
    const Element& e = surface.element(m);
    inactive += e.active ? 0 : 1;
    for (const std::int32_t next : e.neighbour) {
      EXPECT_TRUE(next == kNoElement || surface.element(next).active);
    }
  }
  EXPECT_EQ(inactive, 6);
}

struct Refusal {
  const char* name;
  std::function<void(Library&)> spoil;
  const char* says;
};

class SurfaceRefuses : public ::testing::TestWithParam<Refusal> {};

TEST_P(SurfaceRefuses, AndSaysWhy) {
  Library library = plate(3, 0.03, uniform);
  ASSERT_NO_THROW(Surface{library});
  GetParam().spoil(library);
  try {
    const Surface surface(library);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().says), std::string::npos) << error.what();
  }
}

Vec3 leaning(double degrees, double azimuth) {
  const double a = degrees * std::acos(-1.0) / 180;
  return {std::sin(a) * std::cos(azimuth), std::sin(a) * std::sin(azimuth), -std::cos(a)};
}

INSTANTIATE_TEST_SUITE_P(
    Conditions, SurfaceRefuses,
    ::testing::Values(
        Refusal{"flipped", [](Library& b) { std::swap(b.triangles[4][0], b.triangles[4][1]); },
                "does not point to its inner side"},
        Refusal{"outward",
                [](Library& b) {
                  b.inward[5] = {0, 0, 1};
                },
                "does not point to its inner side"},
        Refusal{"contradicting",  // each points inside, but 88 degrees off in three directions
                [](Library& b) {
                  const Triangle corner = b.triangles[0];
                  for (int l = 0; l < 3; ++l) {
                    b.inward[static_cast<std::size_t>(corner[static_cast<std::size_t>(l)])] =
                        leaning(88, 2.0943951 * l);
                  }
                },
                "differ too much"},
        Refusal{"no_area", [](Library& b) { b.positions[5] = b.positions[4]; }, "no area"},
        Refusal{"three_at_an_edge", [](Library& b) { b.triangles.push_back(b.triangles[0]); },
                "shared by three"},
        Refusal{"index", [](Library& b) { b.triangles[2][1] = 99; }, "out of range"},
        Refusal{"numbers", [](Library& b) { b.inward.pop_back(); }, "differ in number"},
        Refusal{
            "no_response",
            [](Library& b) { std::fill(b.responses.begin(), b.responses.end(), NodeResponse{}); },
            "no triangle has responses"}),
    [](const auto& case_info) { return case_info.param.name; });

}  // namespace
}  // namespace palpate::test
