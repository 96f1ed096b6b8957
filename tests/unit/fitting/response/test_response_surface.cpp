// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/response_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>

#include "tests/support/surfaces.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/fitting/response/one_triangle.hpp"

namespace palpate::fitting {
namespace {

/// A body of one response vertex at each vertex of the sphere, whose directions are radial.
Body ball(double radius, int divisions) {
  const Library surface = sphere(radius, divisions);
  Body body;
  body.nodes = surface.positions;
  for (std::size_t v = 0; v < body.nodes.size(); ++v)
    body.response.node.push_back(static_cast<std::int32_t>(v));
  body.response.inward = surface.inward;
  body.response.is_site.assign(body.nodes.size(), 1);
  body.response.triangles = surface.triangles;
  return body;
}

TEST(ResponseSurface, PointsMoveByHalfAGridAtMostAndStayThere) {
  for (const double radius : {1e-4, 0.03, 0.5, 7.0}) {
    const std::vector<Vec3> exact = sphere(radius, 3).positions;
    const std::vector<Vec3> points = on_a_grid(exact);
    double farthest = 0;
    for (std::size_t v = 0; v < exact.size(); ++v)
      for (std::size_t i = 0; i < 3; ++i)
        farthest = std::max(farthest, std::abs(points[v][i] - exact[v][i]));
    EXPECT_GT(farthest, 0);
    EXPECT_LE(farthest, 2 * radius * std::ldexp(1.0, -24));  // the grid is below 2 extents/2^24
    EXPECT_EQ(on_a_grid(points), points);
  }
}

TEST(ResponseSurface, PlanesOfBinaryFractionsStayExact) {
  const std::vector<Vec3> points{{0, 0, -0.125}, {0.25, 0, -0.125}, {0, 0.25, -0.125}};
  EXPECT_EQ(on_a_grid(points), points);
}

TEST(ResponseSurface, ASinglePointIsKept) {
  const std::vector<Vec3> point{{0.1, 0.2, 0.3}};
  EXPECT_EQ(on_a_grid(point), point);
}

TEST(ResponseSurface, DirectionsKeepLengthAndAngle) {
  const Body body = ball(0.04, 3);
  Library library;
  set_response_surface(body, library);
  ASSERT_EQ(library.inward.size(), body.response.inward.size());
  for (std::size_t v = 0; v < library.inward.size(); ++v) {
    EXPECT_NEAR(norm(library.inward[v]), 1, 6e-8);
    EXPECT_LT(norm(library.inward[v] - body.response.inward[v]), 6e-8);
  }
}

TEST(ResponseSurface, TrianglesThatTouchASupportAreLeftOut) {
  Body body = one_triangle();
  Library library;
  set_response_surface(body, library);
  EXPECT_EQ(library.triangles.size(), 1u);
  body.response.is_site[1] = 0;
  Library without;
  set_response_surface(body, without);
  EXPECT_TRUE(without.triangles.empty());
  EXPECT_EQ(without.positions.size(), 3u);
}

TEST(ResponseSurface, KnowsTheLibraryOfItsBody) {
  const Body body = ball(0.04, 2);
  Library library;
  set_response_surface(body, library);
  EXPECT_TRUE(has_surface_of(body, library));
  library.positions[5][0] += 1e-7;
  EXPECT_FALSE(has_surface_of(body, library));
  library.positions = sphere(0.04, 2).positions;  // of a fit that did not round
  EXPECT_TRUE(has_surface_of(body, library));
  library.positions.pop_back();
  EXPECT_FALSE(has_surface_of(body, library));
}

TEST(ResponseSurface, TakesTwoThirdsOfTheRoomInAFile) {
  const samples::TemporaryFolder folder;
  const auto size_of = [&](const Library& library) {
    const auto file = folder / "library.h5";
    write_library(file, library);
    return static_cast<double>(std::filesystem::file_size(file));
  };
  const Body body = ball(0.04, 4);
  Library library;
  set_response_surface(body, library);
  library.responses.resize(library.positions.size());
  const double on_the_grid = size_of(library);
  library.positions = body.nodes;
  library.inward = body.response.inward;
  const double exact = size_of(library);
  library.positions.assign(library.positions.size(), Vec3{});
  library.inward.assign(library.inward.size(), Vec3{0, 0, 1});
  const double all_else = size_of(library);
  EXPECT_LT(on_the_grid - all_else, 0.67 * (exact - all_else));
}

}  // namespace
}  // namespace palpate::fitting
