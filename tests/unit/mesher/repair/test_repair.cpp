// SPDX-License-Identifier: AGPL-3.0-or-later
// Faulty copies of shapes of known volume: each repair must give the volume back.
#include "mesher/repair/repair.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "format/error.hpp"
#include "mesher/geometry/faulty_faces.hpp"
#include "mesher/geometry/queries.hpp"
#include "mesher/repair/soundness.hpp"
#include "tests/unit/mesher/repair/soups.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr double kRadius = 0.03;  // m

using test::joined;
using test::soup_of;
using test::unconnected;

Surface ball() {
  return test::sphere({0, 0, 0}, kRadius, 32);
}

struct Repaired {
  Surface surface;
  RepairReport report;
};

Repaired repaired(const Soup& soup, const RepairSettings& settings = {}) {
  Repaired result;
  result.surface = repair(soup, settings, "body.stl", result.report);
  return result;
}

/// Sound, of the volume of `shape` within `tolerance` (relative), and repaired by `step`.
void expect_repaired(const Soup& soup, const Surface& shape, const std::string& step,
                     double tolerance = 1e-9, const RepairSettings& settings = {}) {
  EXPECT_FALSE(is_sound(soup));
  const Repaired result = repaired(soup, settings);
  EXPECT_TRUE(is_sound(soup_of(result.surface)));
  EXPECT_NEAR(signed_volume(result.surface) / signed_volume(shape), 1, tolerance);
  EXPECT_THAT(result.report.steps, Contains(HasSubstr(step)));
}

void expect_refused(const Soup& soup, const std::string& problem, const std::string& remedy,
                    const RepairSettings& settings = {}) {
  RepairReport report;
  try {
    repair(soup, settings, "body.stl", report);
    FAIL() << "repaired, expected: " << problem;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Geometry);
    EXPECT_THAT(error.problem(), HasSubstr(problem));
    EXPECT_THAT(error.remedy(), HasSubstr(remedy));
  }
}

TEST(Repair, ADuplicateFaceIsRemoved) {
  Soup soup = soup_of(ball());
  soup.polygons.push_back(soup.polygons[7]);
  expect_repaired(soup, ball(), "1 duplicate or collapsed face");
}

TEST(Repair, AMissingTriangleIsFilled) {
  Soup soup = soup_of(ball());
  soup.polygons.erase(soup.polygons.begin() + 7);
  expect_repaired(soup, ball(), "filled 1 hole");
}

TEST(Repair, ATJunctionIsSplit) {
  // The triangle (0, 2, 1) of the bottom is split at the middle of its edge 0-1; its neighbour in
  // the front face is not.
  const Surface box = test::box({0, 0, 0}, {0.05, 0.04, 0.03});
  Soup soup = soup_of(box);
  soup.points.push_back(0.5 * (box.points[0] + box.points[1]));
  soup.polygons[0] = {0, 2, 8};
  soup.polygons.push_back({8, 2, 1});
  expect_repaired(soup, box, "1 T-junction");
}

TEST(Repair, AFloatingSpeckIsRemoved) {
  const Surface speck = test::box({0.06, 0, 0}, {0.0605, 0.0005, 0.0005});
  expect_repaired(soup_of(joined(ball(), speck)), ball(), "removed 1 separate part");
}

TEST(Repair, CopiesOfPointsThatDifferByNoiseAreMerged) {
  Soup soup = unconnected(test::box({0, 0, 0}, {0.05, 0.05, 0.05}));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> noise(-1e-5 * 0.05, 1e-5 * 0.05);
  for (Vec3& x : soup.points)
    for (double& coordinate : x) coordinate += noise(random);
  // Each face moves by 1e-5 of the edge at most: the volume by 6e-5.
  expect_repaired(soup, test::box({0, 0, 0}, {0.05, 0.05, 0.05}), "merged", 1e-4);
}

TEST(Repair, TurnedFacesAreOriented) {
  Soup soup = soup_of(ball());
  for (std::size_t p = 0; p < soup.polygons.size(); p += 3)
    std::swap(soup.polygons[p][0], soup.polygons[p][1]);
  EXPECT_TRUE(is_sound(soup));  // once the faces are oriented
  EXPECT_NEAR(signed_volume(repaired(soup).surface), signed_volume(ball()), 1e-12);
  for (auto& corners : soup.polygons = soup_of(ball()).polygons) std::swap(corners[0], corners[1]);
  EXPECT_NEAR(signed_volume(repaired(soup).surface), signed_volume(ball()), 1e-12);
}

TEST(Repair, AFlatCutOfAnySizeIsClosed) {
  // A cylinder without its lower cap.
  const Surface whole = test::cylinder(kRadius, 0.1, 48);
  Soup soup = soup_of(whole);
  std::erase_if(soup.polygons, [&](const auto& corners) {
    return std::all_of(corners.begin(), corners.end(),
                       [&](std::size_t v) { return soup.points[v][2] == 0; });
  });
  RepairSettings settings;
  settings.max_hole = 0.01;
  expect_repaired(soup, whole, "filled 1 hole", 1e-9, settings);
}

/// The volume of a ball below a height over its radius, from -1 to 1.
double cap_volume(double height) {
  const double depth = kRadius * (1 + height);
  return std::numbers::pi * depth * depth * (3 * kRadius - depth) / 3;
}

TEST(Repair, AnOpenShellIsFilledWithAWarningOfItsPlaceAndSize) {
  // The border of the hole lies between two heights, and so does its patch: 75 mm across.
  const Surface shell = test::without(test::sphere({0, 0, 0}, kRadius, 64), [](const Vec3& x) {
    return x[0] > 0.3 * kRadius + 0.4 * std::abs(x[1]);
  });
  RepairSettings settings;
  settings.max_hole = 0.1;
  const Repaired result = repaired(soup_of(shell), settings);
  EXPECT_TRUE(is_sound(soup_of(result.surface)));
  EXPECT_GT(signed_volume(result.surface), cap_volume(0.2));
  EXPECT_LT(signed_volume(result.surface), cap_volume(0.75));
  EXPECT_LT(result.report.moved, 1e-15);
  ASSERT_EQ(result.report.warnings.size(), 1U);
  EXPECT_THAT(
      result.report.warnings[0],
      testing::ContainsRegex("a hole of 7[0-5][0-9.]* mm at \\(1[0-9.]+, .*larger than max_hole = "
                             "0.1 .*filled with a patch of 2[0-9]+"));
}

TEST(Repair, ASmallHoleIsFilledWithoutAWarning) {
  Soup soup = soup_of(ball());
  soup.polygons.erase(soup.polygons.begin() + 7);
  EXPECT_THAT(repaired(soup).report.warnings, testing::IsEmpty());
}

TEST(Repair, AnOpenSheetIsRefusedWithItsFaces) {
  Surface sheet;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) sheet.points.push_back({0.01 * i, 0.01 * j, 0});
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const std::int32_t v = 5 * i + j;
      sheet.triangles.push_back({v, v + 5, v + 6});
      sheet.triangles.push_back({v, v + 6, v + 1});
    }
  }
  RepairReport report;
  try {
    repair(soup_of(sheet), {}, "body.stl", report);
    FAIL() << "accepted";
  } catch (const FaultySurface& fault) {
    EXPECT_THAT(fault.problem(), HasSubstr("do not bound a volume"));
    EXPECT_THAT(fault.remedy(), HasSubstr("thickness"));
    EXPECT_EQ(fault.faces().faults.size(), 32U);
  }
}

TEST(Repair, FacesOfAGridOfCellsAreRefused) {
  // 4 x 4 x 4 cubes with all their walls: no sheet is the surface of the body.
  Surface cells;
  for (int i = 0; i < 64; ++i) {
    const Vec3 low = 0.01 * Vec3{1.0 * (i % 4), 1.0 * (i / 4 % 4), 1.0 * (i / 16)};
    append(cells, test::box(low, low + Vec3{0.01, 0.01, 0.01}));
  }
  Soup soup = soup_of(cells);
  tidy(soup, "cells.stl", {});
  expect_refused(soup, "do not separate into one main sheet", "surface.repair = \"wrap\"",
                 {.largest_part = true});
  // The wrap has the volume of all cells, 40 mm wide and an offset of 1/1500 on each side.
  const Repaired wrapped = repaired(soup, {RepairMode::Wrap});
  EXPECT_NEAR(signed_volume(wrapped.surface) / std::pow(0.04, 3), 1, 0.02);
}

/// The volume of two balls of kRadius whose centres are `apart`: both less the lens between them.
double union_volume(double apart) {
  const double height = kRadius - apart / 2;
  const double lens = 2 * std::numbers::pi * height * height * (3 * kRadius - height) / 3;
  return 8 * std::numbers::pi / 3 * std::pow(kRadius, 3) - lens;
}

/// Two balls that overlap, of different meshes.
Surface overlapping_balls(double apart) {
  return joined(test::sphere({0, 0, 0}, kRadius, 48),
                test::sphere({apart, 0.01 * kRadius, 0}, kRadius, 48));
}

TEST(Repair, TheWrapOfPartsThatOverlapIsTheirUnion) {
  const double apart = 1.2 * kRadius;
  const Repaired result = repaired(soup_of(overlapping_balls(apart)), {RepairMode::Wrap});
  EXPECT_TRUE(is_sound(soup_of(result.surface)));
  EXPECT_NEAR(signed_volume(result.surface) / union_volume(apart), 1, 0.02);
}

TEST(Repair, ASurfaceThatCrossesItselfInManyPlacesIsWrappedWithAWarning) {
  // A bridge of two triangles makes one part of the balls: two edges of one are opened and sewn to
  // two of the other, at points that face each other.
  const double apart = 1.9 * kRadius;
  Surface balls = overlapping_balls(apart);
  const auto half = static_cast<std::int32_t>(balls.points.size() / 2);
  const auto outermost = [&](std::int32_t begin, double sign) {
    std::size_t best = 0;
    double height = -1;
    for (std::size_t t = 0; t < balls.triangles.size(); ++t) {
      const Triangle& triangle = balls.triangles[t];
      const bool mine = (triangle[0] < half) == (begin == 0);
      double sum = 0;
      for (const std::int32_t v : triangle) sum += balls.points[static_cast<std::size_t>(v)][1];
      if (mine && sign * sum > height) {
        height = sign * sum;
        best = t;
      }
    }
    return best;
  };
  const Triangle a = balls.triangles[outermost(0, 1)], b = balls.triangles[outermost(half, 1)];
  std::erase_if(balls.triangles, [&](const Triangle& t) { return t == a || t == b; });
  // The tube between the two triangles.
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    balls.triangles.push_back({a[k], a[next], b[(3 - k) % 3]});
    balls.triangles.push_back({a[next], b[(3 - next) % 3], b[(3 - k) % 3]});
  }
  ASSERT_GT(count_self_intersections(balls), 0U);
  const Repaired result = repaired(soup_of(balls));
  EXPECT_TRUE(is_sound(soup_of(result.surface)));
  EXPECT_NEAR(signed_volume(result.surface) / union_volume(apart), 1, 0.03);
  EXPECT_THAT(result.report.steps, Contains(HasSubstr("alpha wrap")));
  ASSERT_EQ(result.report.warnings.size(), 1U);
  EXPECT_THAT(result.report.warnings[0],
              HasSubstr("% of the area of the file lies farther than max_change"));
}

TEST(Repair, SeveralPartsAreRefusedWithTheirSizesAndTheLargestIsKeptOnRequest) {
  const Surface other = test::sphere({0.1, 0, 0}, 0.5 * kRadius, 16);
  const Soup soup = soup_of(joined(other, ball()));
  expect_refused(soup, "2 separate parts, the largest first: (-30", "surface.parts = \"largest\"");
  RepairSettings settings;
  settings.largest_part = true;
  expect_repaired(soup, ball(), "removed 1 separate part", 1e-9, settings);
}

TEST(Repair, ALocalSelfIntersectionIsRemoved) {
  Surface folded = test::sphere({0, 0, 0}, kRadius, 64);
  // Two neighbouring points of the equator change places.
  const auto near_equator = [&](std::size_t v) { return std::abs(folded.points[v][2]) < 1e-9; };
  std::size_t first = 0;
  while (!near_equator(first)) ++first;
  std::swap(folded.points[first], folded.points[first + 1]);
  ASSERT_GT(count_self_intersections(folded), 0U);
  RepairSettings settings;
  settings.max_change = 0.05;
  expect_repaired(soup_of(folded), test::sphere({0, 0, 0}, kRadius, 64), "self-intersection", 2e-3,
                  settings);
}

TEST(Repair, SaysHowFarTheSurfaceMoved) {
  // The floating speck does not count; nothing else moves.
  const Surface speck = test::box({0.06, 0, 0}, {0.0605, 0.0005, 0.0005});
  const Repaired result = repaired(soup_of(joined(ball(), speck)));
  EXPECT_LT(result.report.moved, 1e-15);
  EXPECT_LT(result.report.added, 1e-15);
  EXPECT_NEAR(result.report.volume, signed_volume(ball()), 1e-15);
}

TEST(Repair, NamesOfFacesAreHandedOn) {
  Soup soup = soup_of(ball());
  soup.known_names = {{"south"}, {"north"}};
  for (const auto& corners : soup.polygons)
    soup.names.push_back(
        soup.points[corners[0]][2] + soup.points[corners[1]][2] + soup.points[corners[2]][2] > 0);
  soup.polygons.erase(soup.polygons.begin() + 7);
  soup.names.erase(soup.names.begin() + 7);
  const Surface surface = repaired(soup).surface;
  ASSERT_EQ(surface.names.size(), surface.triangles.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    double height = 0;
    for (const std::int32_t v : surface.triangles[t])
      height += surface.points[static_cast<std::size_t>(v)][2];
    if (std::abs(height) > 1e-6) {
      EXPECT_EQ(surface.names[t], height > 0 ? 1U : 0U) << t;
    }
  }
}

}  // namespace
}  // namespace palpate::mesher
