// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "format/edge.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/queries.hpp"
#include "mesher/read/read_surface.hpp"
#include "mesher/skin/coarsen.hpp"
#include "mesher/skin/remesh.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

constexpr double kFeatureAngle = std::numbers::pi / 4;

Surface fine_of(const Surface& input, double size) {
  return remesh(input, {size, 1, kFeatureAngle}, "fine", {}).boundary;
}

std::vector<double> edge_lengths(const Surface& surface) {
  std::vector<double> lengths;
  for (const Edge& e : edges_of(surface.triangles))
    lengths.push_back(norm(surface.points[to_index(e[1])] - surface.points[to_index(e[0])]));
  std::sort(lengths.begin(), lengths.end());
  return lengths;
}

double smallest_angle(const Surface& surface) {
  double smallest = std::numbers::pi;
  for (const Triangle& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = [&](std::size_t i) { return surface.points[to_index(t[(k + i) % 3])]; };
      const Vec3 a = at(1) - at(0), b = at(2) - at(0);
      smallest = std::min(smallest, std::atan2(norm(cross(a, b)), dot(a, b)));
    }
  return smallest;
}

/// Closed, manifold, of the Euler characteristic, without self-intersections, and made of points
/// of the fine surface.
void expect_sound(const CoarseSurface& coarse, const Surface& fine, int euler) {
  const Surface& s = coarse.surface;
  std::map<std::pair<std::int32_t, std::int32_t>, int> uses;
  for (const Triangle& t : s.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
  for (const auto& [edge, count] : uses) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(uses.contains({edge.second, edge.first}));
  }
  const auto vertices = static_cast<int>(s.points.size());
  EXPECT_EQ(vertices - static_cast<int>(uses.size() / 2) + static_cast<int>(s.triangles.size()),
            euler);
  EXPECT_EQ(count_self_intersections(s), 0U);
  ASSERT_EQ(coarse.fine_point.size(), s.points.size());
  std::set<std::int32_t> distinct;
  for (std::size_t v = 0; v < s.points.size(); ++v) {
    EXPECT_EQ(s.points[v], fine.points[to_index(coarse.fine_point[v])]);
    distinct.insert(coarse.fine_point[v]);
  }
  EXPECT_EQ(distinct.size(), s.points.size());
}

TEST(Coarsen, EdgesOfASphereAreNearTheSpacing) {
  const Surface fine = fine_of(test::sphere({0, 0, 0}, 0.05, 120), 0.004);
  const CoarseSurface coarse = coarsen(fine, 0.012, kFeatureAngle);
  expect_sound(coarse, fine, 2);
  const std::vector<double> lengths = edge_lengths(coarse.surface);
  double sum = 0;
  for (const double l : lengths) sum += l;
  EXPECT_NEAR(sum / static_cast<double>(lengths.size()), 0.012, 0.0012);
  EXPECT_GT(lengths.front(), 0.006);
  EXPECT_LT(lengths.back(), 1.6 * 0.012 + 1e-9);
  EXPECT_GT(smallest_angle(coarse.surface), 15 * std::numbers::pi / 180);
}

// Chords of length s on a sphere of radius R lie s^2/(8 R) inside it, so the volume shrinks by a
// multiple of (s/R)^2: halving s quarters the loss.
TEST(Coarsen, VolumeOfASphereConvergesWithTheSquareOfTheSpacing) {
  const Surface fine = fine_of(test::sphere({0, 0, 0}, 0.05, 200), 0.002);
  const double exact = signed_volume(fine);
  const double wide = 1 - signed_volume(coarsen(fine, 0.020, kFeatureAngle).surface) / exact;
  const double narrow = 1 - signed_volume(coarsen(fine, 0.010, kFeatureAngle).surface) / exact;
  EXPECT_GT(wide, 0);
  EXPECT_NEAR(wide / narrow, 4, 1);
  EXPECT_LT(wide, 0.25 * 0.020 * 0.020 / (0.05 * 0.05) * 3);
}

TEST(Coarsen, ABoxKeepsItsCreasesAndItsVolume) {
  const Surface fine = fine_of(test::box({0, 0, 0}, {0.05, 0.04, 0.03}), 0.003);
  const CoarseSurface coarse = coarsen(fine, 0.010, kFeatureAngle);
  expect_sound(coarse, fine, 2);
  EXPECT_NEAR(signed_volume(coarse.surface), 0.05 * 0.04 * 0.03, 1e-12);
  EXPECT_LT(coarse.surface.triangles.size(), fine.triangles.size() / 4);
}

TEST(Coarsen, ThinWallsStayApart) {
  // A plate of 2 mm under patches of 8 mm: its two sides must not touch.
  const Surface fine = fine_of(test::box({0, 0, 0}, {0.06, 0.06, 0.002}), 0.001);
  const CoarseSurface coarse = coarsen(fine, 0.008, kFeatureAngle);
  expect_sound(coarse, fine, 2);
  EXPECT_NEAR(signed_volume(coarse.surface), 0.06 * 0.06 * 0.002, 1e-12);
}

TEST(Coarsen, KeepsTheGenusOfAKnot) {
  SurfaceFile file{palpate::test::source_folder() / "tests/data/surfaces/trimesh/quadknot.obj",
                   0.001, ""};
  const Surface knot = read_surface(file, {});
  const CoarseSurface coarse = coarsen(knot, 0.012, kFeatureAngle);
  expect_sound(coarse, knot, 0);
  // The tube is thin: patches of 12 mm cannot follow it everywhere.
  EXPECT_LT(coarse.surface.triangles.size(), knot.triangles.size() * 2 / 3);
}

TEST(Coarsen, ASurfaceOfTheSpacingStaysAsItIs) {
  const Surface fine = fine_of(test::sphere({0, 0, 0}, 0.05, 120), 0.010);
  const CoarseSurface coarse = coarsen(fine, 0.010, kFeatureAngle);
  EXPECT_GT(coarse.surface.points.size(), fine.points.size() * 9 / 10);
}

}  // namespace
}  // namespace palpate::mesher
