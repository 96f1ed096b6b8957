// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/support/outlines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "format/edge.hpp"
#include "mesher/geometry/queries.hpp"
#include "mesher/mesher.hpp"
#include "mesher/skin/remesh.hpp"
#include "tests/unit/mesher/body_checks.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kFeatureAngle = kPi / 4;

double length_of(const Surface& surface, const std::vector<Edge>& outline) {
  double sum = 0;
  for (const Edge& e : outline)
    sum += norm(surface.points[static_cast<std::size_t>(e[1])] -
                surface.points[static_cast<std::size_t>(e[0])]);
  return sum;
}

OutlinedSurface outlined(const Surface& skin, const Zone& support, double element_size) {
  Settings settings;
  settings.supports = {support};
  settings.element_size = element_size;
  return with_outlines(skin, settings);
}

TEST(Outlines, PlaneCutsASphereAlongACircle) {
  const Surface ball = test::sphere({0, 0, 0}, 0.05, 240);
  for (const bool inverted : {false, true}) {
    const OutlinedSurface cut =
        outlined(ball, {PlaneSupport{{0, 0, -0.0303}, {0, 0, -1}}, inverted}, 0.01);
    ASSERT_EQ(cut.parts.size(), 1U);
    const double radius = std::sqrt(0.05 * 0.05 - 0.0303 * 0.0303);
    EXPECT_NEAR(length_of(cut.surface, cut.parts[0].outline), 2 * kPi * radius, 1e-3 * radius);
    for (const Edge& e : cut.parts[0].outline)
      for (const std::int32_t v : e)
        EXPECT_NEAR(cut.surface.points[static_cast<std::size_t>(v)][2], -0.0303, 1e-12);
    EXPECT_NEAR(area(cut.surface), area(ball), 1e-12 * area(ball));
  }
}

// No corner of the box lies inside these shapes.
TEST(Outlines, ShapesInTheMiddleOfATriangleHaveOne) {
  const Surface box = test::box({0, 0, 0}, {0.1, 0.1, 0.03});
  const OutlinedSurface ball = outlined(box, SphereSupport{{0.05, 0.05, 0.03}, 0.02}, 0.005);
  EXPECT_NEAR(length_of(ball.surface, ball.parts[0].outline), 2 * kPi * 0.02,
              0.005 * 2 * kPi * 0.02);
  const OutlinedSurface square =
      outlined(box, BoxSupport{{0.03, 0.02, 0.02}, {0.06, 0.07, 0.04}}, 0.005);
  EXPECT_NEAR(length_of(square.surface, square.parts[0].outline), 2 * (0.03 + 0.05), 0.03 * 0.16);
  EXPECT_NEAR(area(square.surface), area(box), 1e-12);
}

TEST(Outlines, NamedFacesEndAtTheirEdges) {
  Surface box = test::box({0, 0, 0}, {0.1, 0.08, 0.03});
  box.known_names = {{"base"}, {"rest"}};
  for (const Triangle& t : box.triangles)
    box.names.push_back(area_vector(box.points, t)[2] < -1e-9 ? 0 : 1);
  const OutlinedSurface named = outlined(box, LabelSupport{"base"}, 0.005);
  EXPECT_NEAR(length_of(named.surface, named.parts[0].outline), 2 * (0.1 + 0.08), 1e-12);
}

TEST(Outlines, FixedSupportsThatOverlapHaveOneOutlineAndSpringsTheirOwn) {
  const Surface ball = test::sphere({0, 0, 0}, 0.05, 240);
  Settings settings;
  settings.supports = {PlaneSupport{{0, 0, -0.03}, {0, 0, -1}},
                       PlaneSupport{{0, 0, -0.02}, {0, 0, -1}}};
  settings.foundation = {{PlaneSupport{{0, 0, 0.04}, {0, 0, 1}}, 1e5, 1e5}};
  settings.element_size = 0.01;
  const OutlinedSurface cut = with_outlines(ball, settings);
  ASSERT_EQ(cut.parts.size(), 2U);
  const auto circle = [](double z) { return 2 * kPi * std::sqrt(0.05 * 0.05 - z * z); };
  EXPECT_NEAR(length_of(cut.surface, cut.parts[0].outline), circle(0.02), 1e-3 * circle(0.02));
  EXPECT_NEAR(length_of(cut.surface, cut.parts[1].outline), circle(0.04), 1e-3 * circle(0.04));
}

/// Area of the facets with three fixed nodes.
double fixed_area(const Body& body) {
  std::vector<bool> fixed(body.nodes.size(), false);
  for (const std::int32_t node : body.fixed_nodes) fixed[static_cast<std::size_t>(node)] = true;
  double sum = 0;
  for (const Triangle& t : body.boundary)
    if (std::all_of(t.begin(), t.end(),
                    [&](std::int32_t v) { return fixed[static_cast<std::size_t>(v)]; }))
      sum += norm(area_vector(body.nodes, t)) / 2;
  return sum;
}

// The cap of a ball beyond a plane has the part h / (2 R) of its area [Archimedes], whichever way
// the support is described.
TEST(Outlines, FixedAreaIsThatOfTheSupportForAnyElements) {
  constexpr double kRadius = 0.05, kHeight = 0.0223;
  const test::TemporaryFile file("ball.off",
                                 test::off_text(test::sphere({0, 0, 0}, 1000 * kRadius, 240)));
  const PlaneSupport beyond{{0, 0, kHeight - kRadius}, {0, 0, -1}};
  const PlaneSupport before{{0, 0, kHeight - kRadius}, {0, 0, 1}};
  for (const double size : {0.012, 0.006}) {
    for (const Zone& support : {Zone(beyond), Zone(before, true)}) {
      Settings settings;
      settings.surface = {file.path(), 0.001, "matrix"};
      settings.supports = {support};
      settings.method = MeshMethod::Isotropic;
      settings.patch_spacing = 0.012;
      settings.element_size = size;
      const Body body = mesh(settings);
      test::expect_sound(body);
      EXPECT_NEAR(fixed_area(body) / test::boundary_area(body), kHeight / (2 * kRadius), 2e-3)
          << size;
    }
  }
}

/// A plate of 60 x 60 x 20 mm on a support, with elements of `size` in patches of 8 mm.
Body plate_on(const Zone& support, double size, MeshMethod method, std::string& log,
              double skin_size = 0) {
  static const test::TemporaryFile file("plate.off",
                                        test::off_text(test::box({0, 0, 0}, {60, 60, 20})));
  Settings settings;
  settings.surface = {file.path(), 0.001, "matrix"};
  settings.supports = {support};
  settings.method = method;
  settings.patch_spacing = 0.008;
  settings.element_size = size;
  settings.skin_size = skin_size;
  settings.tool_radius = 0.002;
  settings.log = [&](std::string_view line) { log += std::string(line) + "\n"; };
  Body body = mesh(settings);
  test::expect_sound(body);
  return body;
}

/// The same by the first way of making a mesh that the method allows.
Body plate_on(const Zone& support, double size, MeshMethod method, double skin_size = 0) {
  std::string log;
  Body body = plate_on(support, size, method, log, skin_size);
  EXPECT_EQ(log.find("does not make a sound mesh"), std::string::npos) << log;
  return body;
}

TEST(Outlines, WithCornersKeepThem) {
  constexpr std::array<std::array<double, 4>, 5> kBases{{{0.011, 0.007, 0.038, 0.052},
                                                         {0.0205, 0.013, 0.047, 0.0335},
                                                         {0.0161, 0.0193, 0.0387, 0.0471},
                                                         {0.0172, 0.0118, 0.0513, 0.0362},
                                                         {0.0241, 0.0227, 0.0444, 0.0431}}};
  for (const auto& [x0, y0, x1, y1] : kBases) {
    const double area = (x1 - x0) * (y1 - y0);
    const BoxSupport base{{x0, y0, -0.005}, {x1, y1, 0.005}};
    EXPECT_NEAR(fixed_area(plate_on(base, 0.004, MeshMethod::Isotropic)), area, 0.03 * area) << x0;
  }
}

// Chords of a round outline lie outside of what is left when its inside is taken out.
TEST(Outlines, AroundASmallHoleLosesNoFacet) {
  for (const double radius : {0.012, 0.016}) {
    const Zone around(SphereSupport{{0.03, 0.03, 0.02}, radius}, true);
    const double hole = kPi * radius * radius;
    for (const MeshMethod method : {MeshMethod::Isotropic, MeshMethod::Delaunay}) {
      const Body body = plate_on(around, 0.004, method);
      EXPECT_NEAR(test::boundary_area(body) - fixed_area(body), hole, 0.03 * hole) << radius;
    }
  }
}

// Edges of a patch have no room along a circle of such a radius: nodes are moved onto it, but for
// response vertices. Without, the support would end half a facet short and lose size / radius of
// its area. Its chords enclose a little less than it does.
TEST(Outlines, OfASupportAsLargeAsAPatchAreFollowedByNodes) {
  for (const auto& [radius, size] : {std::pair{0.008, 0.004}, std::pair{0.0088, 0.008 / 3}}) {
    const double chord = size / radius;
    const double area = kPi * radius * radius * (1 - chord * chord / 6);
    std::string log;
    const Body body =
        plate_on(SphereSupport{{0.03, 0.03, 0.02}, radius}, size, MeshMethod::Isotropic, log);
    EXPECT_NE(log.find("along the outlines of supports does not make a sound mesh"),
              std::string::npos);
    EXPECT_NEAR(fixed_area(body), area, chord / 3 * area) << radius << '\n' << log;
  }
}

// The middles of edges whose nodes have moved lie on the surface, like those of all others.
TEST(Outlines, ThatNodesFollowKeepTheFacetsCurved) {
  constexpr double kRadius = 0.05, kSpot = 0.0126, kSpacing = 0.012;
  const test::TemporaryFile file("ball.off",
                                 test::off_text(test::sphere({0, 0, 0}, 1000 * kRadius, 240)));
  Settings settings;
  settings.surface = {file.path(), 0.001, "matrix"};
  settings.supports = {SphereSupport{{0, 0, kRadius}, kSpot}};
  settings.method = MeshMethod::Isotropic;
  settings.patch_spacing = kSpacing;
  settings.element_size = kSpacing / 4;
  settings.tool_radius = 0.002;
  settings.curved_facets = true;
  std::string log;
  settings.log = [&](std::string_view line) { log += std::string(line) + "\n"; };
  const Body body = mesh(settings);
  ASSERT_NE(log.find("along the outlines of supports does not make a sound mesh"),
            std::string::npos)
      << log;
  test::expect_sound(body);
  EXPECT_TRUE(
      std::is_sorted(body.curved_edges.begin(), body.curved_edges.end(),
                     [](const CurvedEdge& a, const CurvedEdge& b) { return a.ends < b.ends; }));
  EXPECT_EQ(body.curved_edges.size(), edges_of(body.boundary).size());
  for (const CurvedEdge& edge : body.curved_edges) EXPECT_NEAR(norm(edge.middle), kRadius, 2e-5);
}

// Forces on meshes with other vertices cannot be compared.
TEST(Outlines, OfTheSameSkinGiveElementsOfAnySizeTheSameResponseVertices) {
  const SphereSupport support{{0.03, 0.03, 0}, 0.018};
  const auto positions = [&](double size) {
    const Body body = plate_on(support, size, MeshMethod::Isotropic, 0.004);
    std::vector<Vec3> all;
    for (const std::int32_t node : body.response.node)
      all.push_back(body.nodes[static_cast<std::size_t>(node)]);
    return all;
  };
  const std::vector<Vec3> first = positions(0.004);
  EXPECT_EQ(positions(0.008 / 3), first);
  EXPECT_EQ(positions(0.002), first);
}

// A plane 1 mm above the base of a block: facets of 8 mm cannot follow both.
TEST(Outlines, ThatRunsBesideASharpEdgeIsLeftOut) {
  const Surface block = test::box({0, 0, 0}, {0.06, 0.06, 0.03});
  const OutlinedSurface cut = outlined(block, PlaneSupport{{0, 0, 0.001}, {0, 0, -1}}, 0.008);
  EXPECT_NEAR(length_of(cut.surface, cut.parts[0].outline), 0.24, 1e-12);
  std::string log;
  const NestedSurface nested =
      remesh(cut.surface, {0.008, 1, kFeatureAngle, false, {cut.parts[0].outline}}, "block",
             [&](std::string_view line) { log += line; });
  EXPECT_NE(log.find("240 mm of their outlines run beside an edge"), std::string::npos) << log;
  EXPECT_EQ(std::none_of(nested.response.points.begin(), nested.response.points.end(),
                         [](const Vec3& x) { return std::abs(x[2] - 0.001) < 1e-6; }),
            true);
}

// A plane across four sharp edges is followed.
TEST(Outlines, ThatCrossesSharpEdgesIsFollowed) {
  const Surface block = test::box({0, 0, 0}, {0.06, 0.06, 0.04});
  const OutlinedSurface cut = outlined(block, PlaneSupport{{0, 0, 0.017}, {0, 0, -1}}, 0.008);
  const NestedSurface nested =
      remesh(cut.surface, {0.008, 1, kFeatureAngle, false, {cut.parts[0].outline}}, "block", {});
  double below = 0;
  for (const Triangle& t : nested.boundary.triangles) {
    const auto z = [&](std::size_t k) {
      return nested.boundary.points[static_cast<std::size_t>(t[k])][2];
    };
    if (std::max({z(0), z(1), z(2)}) < 0.017 + 1e-9)
      below += norm(area_vector(nested.boundary.points, t)) / 2;
  }
  EXPECT_NEAR(below, 0.06 * 0.06 + 4 * 0.06 * 0.017, 1e-10);
}

}  // namespace
}  // namespace palpate::mesher
