// SPDX-License-Identifier: AGPL-3.0-or-later
// The parts of the mesher on cases with known answers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <type_traits>

#include "format/error.hpp"
#include "mesher/curved_skin.hpp"
#include "mesher/fill.hpp"
#include "mesher/quality.hpp"
#include "mesher/queries.hpp"
#include "mesher/read_surface.hpp"
#include "mesher/remesh.hpp"
#include "mesher/response.hpp"
#include "mesher/thickness.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

using test::off_text;
using test::TemporaryFile;

TEST(ReadSurface, TheFourFormatsGiveTheSameCube) {
  const Surface cube = test::box({0, 0, 0}, {0.05, 0.04, 0.03});
  std::string obj = "# cube\nmtllib none\nweird_keyword 1 2\n";
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty double x\nproperty double y\nproperty "
      "double z\nelement face 12\nproperty list uchar int vertex_indices\nend_header\n";
  std::string stl = "solid cube\n";
  const auto words = [](const Vec3& x) { return text(x[0], " ", x[1], " ", x[2], "\n"); };
  for (const Vec3& x : cube.points) {
    obj += "v " + words(x);
    ply += words(x);
  }
  for (const Triangle& t : cube.triangles) {
    obj += text("f ", t[0] + 1, "/1 ", t[1] - 8, "// ", t[2] + 1, "//3\n");
    ply += text("3 ", t[0], " ", t[1], " ", t[2], "\n");
    stl += "facet normal 0 0 0\nouter loop\n";
    for (const std::int32_t v : t)
      stl += "vertex " + words(cube.points[static_cast<std::size_t>(v)]);
    stl += "endloop\nendfacet\n";
  }
  stl += "endsolid cube\n";
  const TemporaryFile files[] = {
      {"cube.off", off_text(cube)}, {"cube.obj", obj}, {"cube.ply", ply}, {"cube.stl", stl}};
  for (const TemporaryFile& file : files) {
    const Surface read = read_surface({file.path(), 1, ""}, {});
    EXPECT_EQ(read.points.size(), 8U) << file.path();
    EXPECT_EQ(read.triangles.size(), 12U) << file.path();
    EXPECT_NEAR(signed_volume(read), 0.05 * 0.04 * 0.03, 1e-12) << file.path();
  }
}

TEST(ReadSurface, TurnsWhatPointsInwardAndSaysSo) {
  Surface inverted = test::box({0, 0, 0}, {0.05, 0.05, 0.05});
  for (Triangle& t : inverted.triangles) std::swap(t[0], t[1]);
  Surface mixed = test::box({0, 0, 0}, {0.05, 0.05, 0.05});
  for (std::size_t t = 0; t < 3; ++t) std::swap(mixed.triangles[t][0], mixed.triangles[t][1]);
  const TemporaryFile a("inverted.off", off_text(inverted)), b("mixed.off", off_text(mixed));
  std::string log;
  const Log collect = [&](std::string_view line) { log += std::string(line) + "\n"; };
  EXPECT_NEAR(signed_volume(read_surface({a.path(), 1, ""}, collect)), 1.25e-4, 1e-15);
  EXPECT_THAT(log, testing::HasSubstr("pointed inward"));
  log.clear();
  EXPECT_NEAR(signed_volume(read_surface({b.path(), 1, ""}, collect)), 1.25e-4, 1e-15);
  EXPECT_THAT(log, testing::HasSubstr("turned 3 faces"));
}

/// A box whose lid has corners of its own, `gap` above those of the walls.
std::string box_with_a_loose_lid(double gap) {
  Surface s = test::box({0, 0, 0}, {0.05, 0.05, 0.05});
  std::map<std::size_t, std::size_t> own;
  for (Triangle& t : s.triangles) {
    const auto of_lid = [&](auto v) { return s.points[static_cast<std::size_t>(v)][2] > 0.04; };
    if (!std::all_of(t.begin(), t.end(), of_lid)) continue;
    for (auto& v : t) {
      const auto corner = static_cast<std::size_t>(v);
      if (!own.contains(corner)) {
        own[corner] = s.points.size();
        s.points.push_back(s.points[corner] + Vec3{0, 0, gap});
      }
      v = static_cast<std::remove_reference_t<decltype(v)>>(own[corner]);
    }
  }
  return off_text(s);
}

TEST(ReadSurface, SeamsThatDifferByRoundingAreClosedAndNoOthers) {
  std::string log;
  const Log collect = [&](std::string_view line) { log += std::string(line) + "\n"; };
  const TemporaryFile rounded("rounded.off", box_with_a_loose_lid(5e-8));
  const Surface closed = read_surface({rounded.path(), 1, ""}, collect);
  EXPECT_EQ(closed.points.size(), 8U);
  EXPECT_NEAR(signed_volume(closed), 0.05 * 0.05 * 0.05, 1e-9);
  EXPECT_THAT(log, testing::HasSubstr("closed a seam: joined 4 points"));
  const TemporaryFile open("open.off", box_with_a_loose_lid(5e-7));
  EXPECT_THROW(read_surface({open.path(), 1, ""}, collect), Error);
}

TEST(ReadSurface, QuadsBecomeTrianglesOfTheSameVolume) {
  const TemporaryFile file(
      "quads.obj",
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
      "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const Surface read = read_surface({file.path(), 0.1, ""}, {});
  EXPECT_EQ(read.triangles.size(), 12U);
  EXPECT_NEAR(signed_volume(read), 1e-3, 1e-15);
}

TEST(Queries, InsideOutsideAndRays) {
  const SurfaceQuery query(test::box({0, 0, 0}, {1, 2, 3}));
  EXPECT_TRUE(query.contains({0.5, 0.5, 2.999}));
  EXPECT_FALSE(query.contains({0.5, 0.5, 3.001}));
  EXPECT_FALSE(query.contains({0.5, 0.5, 3}));
  EXPECT_NEAR(query.first_hit({0.4, 0.3, 1}, {0, 0, 1}).value(), 2, 1e-14);
  EXPECT_FALSE(query.first_hit({0.4, 0.3, 4}, {0, 0, 1}).has_value());
  const Vec3 foot = query.closest({0.4, 0.3, 5}).point;
  EXPECT_NEAR(norm(foot - Vec3{0.4, 0.3, 3}), 0, 1e-14);
}

TEST(Remesh, BoxKeepsItsEdgesAndCornersExactly) {
  const Surface box = test::box({0, 0, 0}, {0.05, 0.04, 0.03});
  const NestedSurface nested = remesh(box, {0.008, 3, 45}, "box", {});
  EXPECT_NEAR(signed_volume(nested.boundary), 0.05 * 0.04 * 0.03, 1e-15);
  EXPECT_NEAR(area(nested.boundary), 2 * (0.05 * 0.04 + 0.05 * 0.03 + 0.04 * 0.03), 1e-12);
  for (const Vec3& corner : box.points) {
    const auto& points = nested.response.points;
    EXPECT_TRUE(std::any_of(points.begin(), points.end(),
                            [&](const Vec3& x) { return norm(x - corner) < 1e-12; }));
  }
}

TEST(Remesh, EdgesOfTheResponseSurfaceAreNearTheSpacing) {
  const NestedSurface nested = remesh(test::sphere({0, 0, 0}, 0.05, 120), {0.010, 1, 45}, "s", {});
  double sum = 0;
  for (const Triangle& t : nested.response.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = norm(nested.response.points[static_cast<std::size_t>(t[k])] -
                                 nested.response.points[static_cast<std::size_t>(t[(k + 1) % 3])]);
      EXPECT_GT(length, 0.005);
      EXPECT_LT(length, 0.015);
      sum += length;
    }
  }
  EXPECT_NEAR(sum / static_cast<double>(3 * nested.response.triangles.size()), 0.010, 0.001);
}

TEST(Remesh, AllPointsLieOnTheInputSurface) {
  const Surface input = test::cylinder(0.04, 0.08, 200);
  const NestedSurface nested = remesh(input, {0.012, 4, 45}, "c", {});
  const SurfaceQuery query(input);
  for (const Vec3& x : nested.boundary.points) EXPECT_LT(norm(query.closest(x).point - x), 1e-9);
}

// The middles lie on the surface of the file, its rims included; a box has none.
TEST(Remesh, MiddlesOfCurvedEdgesLieOnTheInputSurface) {
  constexpr double kRadius = 0.04, kLength = 0.08;
  const Surface input = test::cylinder(kRadius, kLength, 400);
  const double chord = kRadius * (1 - std::cos(M_PI / 400));  // of the file
  const NestedSurface nested = remesh(input, {0.012, 2, 45, true}, "c", {});
  EXPECT_GT(nested.curved.size(), nested.boundary.triangles.size() / 2);
  const SurfaceQuery query(input);
  std::size_t on_rims = 0;
  for (const CurvedEdge& edge : nested.curved) {
    EXPECT_LT(norm(query.closest(edge.middle).point - edge.middle), 1e-9);
    const auto end = [&](std::size_t i) {
      return nested.boundary.points[static_cast<std::size_t>(edge.ends[i])];
    };
    EXPECT_NEAR(std::hypot(edge.middle[0], edge.middle[1]), kRadius, 1.1 * chord);
    const double straight = std::hypot(0.5 * (end(0) + end(1))[0], 0.5 * (end(0) + end(1))[1]);
    EXPECT_GT(std::hypot(edge.middle[0], edge.middle[1]), straight);
    const bool rim = end(0)[2] == end(1)[2] && (end(0)[2] == 0 || end(0)[2] == kLength);
    on_rims += rim && std::abs(edge.middle[2] - end(0)[2]) < 1e-12;
  }
  EXPECT_GT(on_rims, 2 * 2 * M_PI * kRadius / 0.0075);  // facets of 6 mm around both
  EXPECT_TRUE(remesh(test::box({0, 0, 0}, {0.05, 0.04, 0.03}), {0.008, 3, 45, true}, "b", {})
                  .curved.empty());
}

// A tetrahedron of height h over its face: by a bulge of more than a fraction of h inward, a part
// of it would turn over.
TEST(CurvedSkin, IsDrawnBackWhereAnElementWouldFold) {
  Body body;
  body.nodes = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0.002, 0.002, -0.001}};
  body.tetrahedra = {{0, 2, 1, 3}};
  body.boundary = {{0, 1, 2}};
  const Vec3 straight{0.005, 0, 0};
  for (const double bulge : {0.00005, -0.00005}) {
    body.curved_edges = {{{0, 1}, straight + Vec3{0, 0, bulge}}};
    EXPECT_EQ(draw_back_edges(body), 0U);
    EXPECT_EQ(body.curved_edges[0].middle[2], bulge);
  }
  body.curved_edges = {{{0, 1}, straight + Vec3{0, 0, -0.0018}}};
  EXPECT_EQ(draw_back_edges(body), 1U);
  ASSERT_EQ(body.curved_edges.size(), 1U);
  EXPECT_LT(body.curved_edges[0].middle[2], 0);
  EXPECT_GE(body.curved_edges[0].middle[2], -0.0018 / 2);
  body.curved_edges = {{{0, 1}, straight + Vec3{0, 0, -1}}};
  EXPECT_EQ(draw_back_edges(body), 1U);
  EXPECT_TRUE(body.curved_edges.empty());
}

TEST(Fill, RefinesToTheRequestedEdgeAndKeepsEveryTriangle) {
  const NestedSurface nested =
      remesh(test::box({0, 0, 0}, {0.05, 0.05, 0.05}), {0.008, 2, 45}, "box", {});
  std::size_t coarser = 0;
  for (const double longest : {0.012, 0.006}) {
    const Filling filling = fill(nested.boundary, longest, "box");
    EXPECT_FALSE(filling.cut_short);
    const Quality quality = measure_quality(filling.nodes, filling.tetrahedra);
    EXPECT_NEAR(quality.volume, 1.25e-4, 1e-15);
    EXPECT_LT(quality.longest_edge, 1.2 * longest);
    EXPECT_GT(quality.smallest_dihedral, 5);
    EXPECT_GT(filling.nodes.size(), coarser);
    coarser = filling.nodes.size();
  }
}

TEST(Fill, ShellsThatCutOneAnotherAreAnErrorNotACrash) {
  Surface crossed = test::sphere({0, 0, 0}, 0.03, 32);
  append(crossed, test::sphere({0.02, 0, 0}, 0.03, 32));
  for (int attempt = 0; attempt < 2; ++attempt) {
    try {
      fill(crossed, 0.01, "crossed");
      FAIL() << "filled";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Geometry);
      EXPECT_THAT(error.what(), testing::HasSubstr("TetGen cannot fill"));
    }
  }
}

TEST(Quality, RegularTetrahedron) {
  const std::vector<Vec3> nodes = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  const Quality quality = measure_quality(nodes, {{0, 1, 3, 2}});
  EXPECT_NEAR(quality.smallest_dihedral, std::acos(1.0 / 3) * 180 / std::numbers::pi, 1e-12);
  EXPECT_NEAR(quality.largest_dihedral, quality.smallest_dihedral, 1e-12);
  EXPECT_NEAR(quality.largest_edge_ratio, 1, 1e-14);
  EXPECT_NEAR(std::abs(quality.volume), 8.0 / 3, 1e-14);
}

TEST(Quality, RightAngledCorner) {
  const std::vector<Vec3> nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Quality quality = measure_quality(nodes, {{0, 1, 2, 3}});
  EXPECT_NEAR(quality.smallest_dihedral, std::acos(1 / std::sqrt(3.0)) * 180 / std::numbers::pi,
              1e-12);
  EXPECT_NEAR(quality.largest_dihedral, 90, 1e-12);
  EXPECT_NEAR(quality.largest_edge_ratio, std::sqrt(2.0), 1e-14);
  EXPECT_NEAR(quality.volume, 1.0 / 6, 1e-15);
}

TEST(Thickness, OfABoxIsItsHeightAlsoWhereTheLineGrazesASide) {
  const NestedSurface nested =
      remesh(test::box({0, 0, 0}, {0.06, 0.06, 0.03}), {0.010, 1, 45}, "box", {});
  const std::vector<Vec3> down(nested.response.points.size(), Vec3{0, 0, -1});
  const auto thickness = thickness_under_tool(nested.boundary, down, 0.005);
  std::size_t edge_points = 0;
  for (std::size_t v = 0; v < down.size(); ++v) {
    const Vec3& x = nested.response.points[v];
    if (x[2] < 0.03 - 1e-9) continue;
    if (x[0] < 1e-9 || x[0] > 0.06 - 1e-9) ++edge_points;
    EXPECT_NEAR(thickness[v], 0.03, 1e-9) << x[0] << ' ' << x[1];
  }
  EXPECT_GT(edge_points, 4U);
}

TEST(Thickness, ThinMaterialBesideASharpEdgeIsThin) {
  // A wedge of 45 degrees: the line down from (x, y, z = x) on its sloping side is x long.
  Surface wedge;
  wedge.points = {{0, 0, 0},    {0.05, 0, 0},    {0.05, 0, 0.05},
                  {0, 0.05, 0}, {0.05, 0.05, 0}, {0.05, 0.05, 0.05}};
  wedge.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1},
                     {1, 4, 5}, {1, 5, 2}, {0, 2, 5}, {0, 5, 3}};
  ASSERT_GT(signed_volume(wedge), 0);
  const NestedSurface nested = remesh(wedge, {0.008, 1, 30}, "wedge", {});
  const Vec3 inward = unit(Vec3{1, 0, -1});
  const std::vector<Vec3> directions(nested.response.points.size(), inward);
  const auto thickness = thickness_under_tool(nested.boundary, directions, 0.005);
  std::size_t inside = 0;
  for (std::size_t v = 0; v < thickness.size(); ++v) {
    const Vec3& x = nested.response.points[v];
    const bool on_slope =
        std::abs(x[2] - x[0]) < 1e-9 && x[0] > 1e-3 && x[0] < 0.02 && x[1] > 1e-3 && x[1] < 0.049;
    if (!on_slope) continue;
    ++inside;
    EXPECT_NEAR(thickness[v], std::sqrt(2.0) * x[0], 1e-9);
  }
  EXPECT_GT(inside, 3U);
}

TEST(InwardDirections, CubeEdgesAndCornersBisectTheirSides) {
  const Surface box = test::box({0, 0, 0}, {1, 1, 1});
  const auto directions = inward_directions(box, box, std::vector<std::uint8_t>(8, 0));
  EXPECT_TRUE(directions.unresolved.empty());
  const Vec3 exact = unit(Vec3{1, 1, 1});
  EXPECT_NEAR(norm(directions.inward[0] - exact), 0, 1e-12);
  EXPECT_EQ(directions.adjusted, 0U);
  EXPECT_EQ(directions.largest_turn, 0);
}

TEST(InwardDirections, NextToASupportTheTouchableSideDecides) {
  const Surface box = test::box({0, 0, 0}, {1, 1, 1});
  std::vector<std::uint8_t> held(8, 0);
  for (std::size_t v = 0; v < 4; ++v) held[v] = 1;  // the bottom
  const auto directions = inward_directions(box, box, held);
  EXPECT_NEAR(directions.inward[0][2], 0, 1e-12);
  EXPECT_GT(directions.inward[0][0], 0.4);
  EXPECT_GT(directions.inward[0][1], 0.4);
}

TEST(InwardDirections, TooSharpASpikeIsTurnedOrReported) {
  // A needle: at its tip the sides are nearly opposite to one another, the mean still points in.
  Surface needle;
  needle.points = {{0, 0, 1}, {0.02, 0, 0}, {-0.01, 0.017, 0}, {-0.01, -0.017, 0}};
  needle.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  ASSERT_GT(signed_volume(needle), 0);
  const auto directions = inward_directions(needle, needle, {0, 0, 0, 1});
  // No direction is 0.1 inside all three sides of so thin a tip.
  EXPECT_THAT(directions.unresolved, testing::Contains(0));
}

TEST(InwardDirections, TellWhichWasTurnedMostAndHowFar) {
  // Leaning spikes, the mean of whose facets does not point into all of them.
  int turned = 0;
  for (int lean = 0; lean < 12; ++lean) {
    Surface spike;
    spike.points = {{0.2 * lean, 0, 0.5}, {1, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.8, 0}};
    spike.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
    const auto directions = inward_directions(spike, spike, {0, 0, 0, 0});
    std::vector<Vec3> sum(4, Vec3{});
    for (const Triangle& t : spike.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto at = [&](std::size_t i) {
          return spike.points[static_cast<std::size_t>(t[i % 3])];
        };
        const Vec3 a = at(k + 1) - at(k), b = at(k + 2) - at(k);
        const double angle = std::acos(dot(a, b) / (norm(a) * norm(b)));
        Vec3& mean = sum[static_cast<std::size_t>(t[k])];
        mean = mean - angle * unit(cross(at(1) - at(0), at(2) - at(0)));
      }
    }
    double largest = 0;
    for (std::size_t v = 0; v < 4; ++v) {
      const double cosine = dot(unit(sum[v]), directions.inward[v]);
      largest = std::max(largest, std::acos(std::min(1.0, cosine)));
    }
    turned += directions.adjusted > 0 ? 1 : 0;
    EXPECT_NEAR(directions.largest_turn, largest, 1e-6);
    EXPECT_NEAR(std::acos(dot(unit(sum[directions.turned_most]),
                              directions.inward[directions.turned_most])),
                largest, 1e-6);
  }
  EXPECT_EQ(turned, 12);  // the rim of so flat a body is as sharp as its tip
}

TEST(Supports, EachShapeHoldsItsInside) {
  const std::vector<Support> plane = {PlaneSupport{{0, 0, 1}, {0, 0, 2}}};
  EXPECT_TRUE(is_held(plane, {5, 5, 1.5}, 0));
  EXPECT_FALSE(is_held(plane, {5, 5, 0.5}, 0));
  EXPECT_TRUE(is_held(plane, {5, 5, 1 - 1e-9}, 1e-6));
  const std::vector<Support> box = {BoxSupport{{0, 0, 0}, {1, 1, 1}}};
  EXPECT_TRUE(is_held(box, {1, 0.5, 0}, 0));
  EXPECT_FALSE(is_held(box, {1.1, 0.5, 0}, 0));
  const std::vector<Support> ball = {SphereSupport{{1, 0, 0}, 0.5}};
  EXPECT_TRUE(is_held(ball, {1.4, 0, 0}, 0));
  EXPECT_FALSE(is_held(ball, {1.4, 0.4, 0}, 0));
}

}  // namespace
}  // namespace palpate::mesher
