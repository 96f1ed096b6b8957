// SPDX-License-Identifier: AGPL-3.0-or-later
// The scripted session's way over the surface, on surfaces whose geodesics are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "app/simulate/surface_path.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

constexpr double kTile = 0.01;  // m

/// A sheet of n x m square tiles, each of two triangles; `place` maps sheet coordinates to space.
template <class Place, class Inward>
Library sheet(int n, int m, Place place, Inward inward) {
  Library library;
  library.name = "sheet";
  for (int j = 0; j <= m; ++j) {
    for (int i = 0; i <= n; ++i) {
      library.positions.push_back(place(i * kTile, j * kTile));
      library.inward.push_back(inward(i * kTile, j * kTile));
      NodeResponse response;
      response.status = ResponseStatus::Fitted;
      library.responses.push_back(response);
    }
  }
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = c - 1;
      library.triangles.push_back({a, b, c});
      library.triangles.push_back({a, c, d});
    }
  }
  return library;
}

Library flat(int n, int m) {
  return sheet(
      n, m,
      [](double x, double y) {
        return Vec3{x, y, 0};
      },
      [](double, double) {
        return Vec3{0, 0, -1};
      });
}

constexpr double kRadius = 0.04;  // m

/// A sheet bent to a cylinder about the y axis: straight lines become helices of the same length.
Library bent(int n, int m) {
  return sheet(
      n, m,
      [](double x, double y) {
        return Vec3{kRadius * std::sin(x / kRadius), y, kRadius * std::cos(x / kRadius)};
      },
      [](double x, double) {
        return Vec3{-std::sin(x / kRadius), 0, -std::cos(x / kRadius)};
      });
}

TEST(SurfacePath, StartsFarFromTheBorder) {
  const Library library = flat(9, 9);
  const std::size_t middle = middle_triangle(library);
  const auto& t = library.triangles[middle];
  for (const std::int32_t vertex : t) {
    const Vec3& p = library.positions[static_cast<std::size_t>(vertex)];
    EXPECT_NEAR(p[0], 0.045, 0.011);
    EXPECT_NEAR(p[1], 0.045, 0.011);
  }
}

TEST(SurfacePath, KeepsOffHoles) {
  Library library = flat(9, 9);
  for (std::size_t v = 0; v < library.positions.size(); ++v) {
    if (library.positions[v][0] < 0.051) library.responses[v].status = ResponseStatus::Hole;
  }
  const std::size_t start = middle_triangle(library);
  for (const PathPoint& point : straight_path(library, start, 1, 0.001)) {
    EXPECT_GE(point.position[0], 0.06 - 1e-12);
  }
}

TEST(SurfacePath, NothingToTouchIsAnError) {
  Library library = flat(2, 2);
  for (NodeResponse& response : library.responses) response.status = ResponseStatus::Hole;
  EXPECT_THROW(middle_triangle(library), Error);
}

TEST(SurfacePath, IsAStraightLineOnAPlane) {
  const Library library = flat(9, 9);
  const auto path = straight_path(library, middle_triangle(library), 0.03, 0.001);
  EXPECT_NEAR(path.back().distance, 0.03, 1e-12);
  const Vec3 chord = path.back().position - path.front().position;
  EXPECT_NEAR(norm(chord), 0.03, 1e-12);
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Vec3 step = path[i].position - path[i - 1].position;
    EXPECT_LE(norm(step), 0.001 + 1e-12);
    EXPECT_NEAR(norm(cross(path[i].position - path.front().position, chord)), 0, 1e-12);
    EXPECT_NEAR(path[i].inward[2], -1, 1e-12);
  }
}

TEST(SurfacePath, EndsAtTheBorder) {
  const Library library = flat(9, 3);
  const auto path = straight_path(library, middle_triangle(library), 1, 0.001);
  EXPECT_GT(path.back().distance, 0.03);
  EXPECT_LT(path.back().distance, 0.1);
  const Vec3& end = path.back().position;
  const double border = std::min({end[0], end[1], 0.09 - end[0], 0.03 - end[1]});
  EXPECT_NEAR(border, 0, 1e-9);
}

TEST(SurfacePath, FollowsACurvedSurface) {
  const Library library = bent(20, 20);
  const auto path = straight_path(library, middle_triangle(library), 0.06, 0.001);
  EXPECT_NEAR(path.back().distance, 0.06, 1e-9);
  const double sagitta = kRadius * (1 - std::cos(kTile / 2 / kRadius));
  for (const PathPoint& point : path) {
    const double r = std::hypot(point.position[0], point.position[2]);
    EXPECT_LE(r, kRadius + 1e-12);
    EXPECT_GE(r, kRadius - sagitta - 1e-12);
    const Vec3 radial{-point.position[0] / r, 0, -point.position[2] / r};
    EXPECT_GT(dot(point.inward, radial), std::cos(0.02));
    EXPECT_NEAR(norm(point.inward), 1, 1e-12);
  }
}

/// A tool that follows the sheet round would come out on its other side: along the axis there is
/// room.
TEST(SurfacePath, EndsBeforeItHasTurnedTooFar) {
  const Library library = bent(20, 20);
  const auto path = straight_path(library, middle_triangle(library), 1, 0.001);
  const auto azimuth = [](const PathPoint& p) { return std::atan2(p.position[0], p.position[2]); };
  for (const PathPoint& point : path)
    EXPECT_LT(std::abs(std::remainder(azimuth(point) - azimuth(path.front()), 2 * M_PI)),
              M_PI / 3 + 0.02);
  EXPECT_GT(path.back().distance, 0.08);
}

/// Middle of the lower triangle of the tile with a corner at (i, j) tiles.
Vec3 middle_of_tile(int i, int j) {
  return {(i + 2.0 / 3) * kTile, (j + 1.0 / 3) * kTile, 0};
}

TEST(PathBetween, JoinsTheTrianglesNearestToTwoPoints) {
  const Library library = flat(9, 9);
  const Vec3 from = middle_of_tile(1, 2), to = middle_of_tile(7, 5), off{0.001, -0.0005, 0.002};
  const auto path = path_between(library, from + off, to + off, 0.001);
  const Vec3 chord = to - from;
  EXPECT_NEAR(norm(path.front().position - from), 0, 1e-12);
  EXPECT_NEAR(norm(path.back().position - to), 0, 1e-12);
  EXPECT_NEAR(path.back().distance, norm(chord), 1e-12);
  for (std::size_t i = 1; i < path.size(); ++i) {
    EXPECT_LE(norm(path[i].position - path[i - 1].position), 0.001 + 1e-12);
    EXPECT_NEAR(norm(cross(path[i].position - from, chord)), 0, 1e-12);
  }
}

TEST(PathBetween, OfATriangleAndItselfIsAPoint) {
  const Library library = flat(3, 3);
  const auto path = path_between(library, middle_of_tile(1, 1), middle_of_tile(1, 1), 0.001);
  EXPECT_EQ(path.size(), 1u);
}

/// Around a cylinder the way is an arc, longer than the chord.
TEST(PathBetween, FollowsACurvedSurface) {
  const Library library = bent(20, 20);
  const auto at = [](double x, double y) {
    return Vec3{kRadius * std::sin(x / kRadius), y, kRadius * std::cos(x / kRadius)};
  };
  const double arc = 0.09;  // m, between middles of triangles at the same height
  const double first = (4 + 2.0 / 3) * kTile, height = (10 + 1.0 / 3) * kTile;
  const auto path = path_between(library, at(first, height), at(first + arc, height), 0.001);
  EXPECT_NEAR(path.back().distance, arc, 0.01 * arc);
  const double sagitta = kRadius * (1 - std::cos(kTile / 2 / kRadius));
  for (const PathPoint& point : path) {
    const double r = std::hypot(point.position[0], point.position[2]);
    EXPECT_LE(r, kRadius + 1e-12);
    EXPECT_GE(r, kRadius - sagitta - 1e-12);
    EXPECT_NEAR(point.position[1], height, 0.1 * kTile);
  }
}

void expect_refused(const Library& library, const Vec3& from, const Vec3& to, const char* where,
                    const char* problem) {
  try {
    path_between(library, from, to, 0.001);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Configuration);
    EXPECT_EQ(error.where(), where);
    EXPECT_THAT(error.problem(), testing::HasSubstr(problem));
  }
}

TEST(PathBetween, RefusesAPointFarFromTheResponses) {
  const Vec3 inside = middle_of_tile(1, 1), far = inside + Vec3{0, 0, 0.05};
  expect_refused(flat(3, 3), far, inside, "simulate.from", "is 50.0 mm away");
  expect_refused(flat(3, 3), inside, far, "simulate.to", "is 50.0 mm away");
}

TEST(PathBetween, RefusesToCrossAHole) {
  Library library = flat(9, 3);
  for (std::size_t v = 0; v < library.positions.size(); ++v) {
    const double x = library.positions[v][0];
    if (x > 0.039 && x < 0.051) library.responses[v].status = ResponseStatus::Hole;
  }
  expect_refused(library, middle_of_tile(1, 1), middle_of_tile(7, 1), "simulate.path",
                 "ends at (30, ");
}

}  // namespace
}  // namespace palpate::app
