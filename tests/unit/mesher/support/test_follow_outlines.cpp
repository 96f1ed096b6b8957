// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/support/follow_outlines.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "format/edge.hpp"
#include "mesher/geometry/quality.hpp"
#include "mesher/geometry/queries.hpp"
#include "mesher/mesher.hpp"
#include "mesher/support/supports.hpp"
#include "tests/unit/mesher/body_checks.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

constexpr double kRadius = 0.05, kHeight = 0.0223;
const PlaneSupport kBeyond{{0, 0, kHeight - kRadius}, {0, 0, -1}};

/// A ball of Delaunay tetrahedra with a support.
Body refined_ball(const PlaneSupport& support, double size) {
  const test::TemporaryFile file("ball.off",
                                 test::off_text(test::sphere({0, 0, 0}, 1000 * kRadius, 240)));
  Settings settings;
  settings.surface = {file.path(), 0.001, "matrix"};
  settings.supports = {support};
  settings.method = MeshMethod::Delaunay;
  settings.patch_spacing = 0.012;
  settings.element_size = size;
  return mesh(settings);
}

double height(const Body& body, std::int32_t v) {
  return body.nodes[static_cast<std::size_t>(v)][2] - kBeyond.point[2];
}

/// Area of the facets beyond the plane over that of all.
double part_beyond(const Body& body) {
  double sum = 0;
  for (const Triangle& t : body.boundary)
    if (std::all_of(t.begin(), t.end(), [&](std::int32_t v) { return height(body, v) < 1e-9; }))
      sum += norm(area_vector(body.nodes, t)) / 2;
  return sum / test::boundary_area(body);
}

std::size_t edges_across(const Body& body) {
  std::size_t count = 0;
  for (const Edge& e : edges_of(body.boundary)) {
    const double a = height(body, e[0]), b = height(body, e[1]);
    if (std::min(a, b) < -1e-9 && std::max(a, b) > 1e-9) ++count;
  }
  return count;
}

// The cap beyond a plane has the part h / (2 R) of the area of the ball [Archimedes].
TEST(FollowOutlines, FixedAreaIsThatOfTheSupportForAnyElements) {
  constexpr double kPart = kHeight / (2 * kRadius);
  const SurfaceQuery ball(test::sphere({0, 0, 0}, kRadius, 240));
  for (const double size : {0.012, 0.006}) {
    const Body body = refined_ball(kBeyond, size);
    test::expect_sound(body);
    EXPECT_NEAR(part_beyond(body), kPart, 0.03 * kPart);
    EXPECT_LT(part_beyond(refined_ball({{0, 0, 0.045}, {0, 0, 1}}, size)), 0.95 * kPart);
    for (const Triangle& t : body.boundary)
      for (const std::int32_t v : t) {
        const Vec3 x = body.nodes[static_cast<std::size_t>(v)];
        EXPECT_LT(norm(ball.closest(x).point - x), 1e-3 * size);
      }
  }
}

TEST(FollowOutlines, TellsTheEdgesThatCrossAndFlattensNoTetrahedron) {
  Body body = refined_ball({{0, 0, 0.045}, {0, 0, 1}}, 0.012);
  const Quality before = measure_quality(body.nodes, body.tetrahedra);
  const std::size_t across = edges_across(body);
  Settings settings;
  settings.element_size = 0.012;
  settings.supports = {kBeyond};
  const OutlinedSurface outlined = with_outlines(test::sphere({0, 0, 0}, kRadius, 240), settings);
  const std::size_t left = follow_outlines(outlined, body.boundary, body.tetrahedra, body.nodes);
  EXPECT_EQ(left, edges_across(body));
  EXPECT_LT(left, across / 5);
  const Quality after = measure_quality(body.nodes, body.tetrahedra);
  EXPECT_GE(after.smallest_dihedral, std::min(5.0, before.smallest_dihedral));
  EXPECT_LE(after.largest_dihedral, std::max(165.0, before.largest_dihedral));
}

// The outline of springs a little beside that of what is fixed takes no node away from it.
TEST(FollowOutlines, OneOutlineDoesNotTakeTheNodesOfAnother) {
  constexpr double kPart = kHeight / (2 * kRadius);
  const test::TemporaryFile file("ball.off",
                                 test::off_text(test::sphere({0, 0, 0}, 1000 * kRadius, 240)));
  for (const double gap : {0.001, 0.003}) {
    const Vec3 above = kBeyond.point + gap * Vec3{0, 0, 1};
    Settings settings;
    settings.surface = {file.path(), 0.001, "matrix"};
    settings.supports = {kBeyond};
    settings.foundation = {{PlaneSupport{above, {0, 0, -1}}, 1e6, 0}};
    settings.method = MeshMethod::Delaunay;
    settings.patch_spacing = 0.012;
    settings.element_size = 0.008;
    const Body body = mesh(settings);
    test::expect_sound(body);
    EXPECT_NEAR(part_beyond(body), kPart, 0.05 * kPart) << gap;
  }
}

// A node of a sharp edge that climbed to an outline beside it would bend the flat face.
TEST(FollowOutlines, AnOutlineBesideASharpEdgeBendsNoFlatFace) {
  const test::TemporaryFile file("plate.off", test::off_text(test::box({0, 0, 0}, {60, 60, 20})));
  const auto flat_base = [&](double height) {
    Settings settings;
    settings.surface = {file.path(), 0.001, "matrix"};
    settings.supports = {PlaneSupport{{0, 0, height}, {0, 0, -1}}};
    settings.method = MeshMethod::Delaunay;
    settings.patch_spacing = settings.element_size = 0.008;
    const Body body = mesh(settings);
    double sum = 0;
    for (const Triangle& t : body.boundary)
      if (std::all_of(t.begin(), t.end(), [&](std::int32_t v) {
            return std::abs(body.nodes[static_cast<std::size_t>(v)][2]) < 2e-4;
          }))
        sum += norm(area_vector(body.nodes, t)) / 2;
    return sum;
  };
  const double without = flat_base(0.0001);
  for (const double height : {0.0015, 0.003}) EXPECT_GT(flat_base(height), 0.9 * without) << height;
}

}  // namespace
}  // namespace palpate::mesher
