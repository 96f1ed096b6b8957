// SPDX-License-Identifier: AGPL-3.0-or-later
#include "mesher/geometry/split_edges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "format/edge.hpp"
#include "mesher/geometry/queries.hpp"
#include "tests/unit/mesher/shapes.hpp"

namespace palpate::mesher {
namespace {

/// A point on every edge for which `choose` is true, at uneven places.
std::map<Edge, Vec3> points_on(const Surface& surface, const std::function<bool(int)>& choose) {
  std::map<Edge, Vec3> points;
  int number = 0;
  for (const Edge& e : edges_of(surface.triangles)) {
    const double t = 0.3 + 0.4 * std::fmod(0.37 * number, 1.0);
    const Vec3 a = surface.points[static_cast<std::size_t>(e[0])];
    const Vec3 b = surface.points[static_cast<std::size_t>(e[1])];
    if (choose(number++)) points.emplace(e, a + t * (b - a));
  }
  return points;
}

// What is divided has the area and the volume of before; every edge that gets a point gives each of
// its two triangles one part more.
TEST(SplitEdges, PartsCoverTheTriangles) {
  const Surface before = test::sphere({0.01, 0, 0}, 0.05, 24);
  for (const int every : {1, 2, 3, 7}) {
    Surface after = before;
    const auto points = points_on(before, [=](int edge) { return edge % every == 0; });
    split_edges(after, points);
    EXPECT_EQ(after.points.size(), before.points.size() + points.size());
    EXPECT_EQ(after.triangles.size(), before.triangles.size() + 2 * points.size());
    EXPECT_NEAR(area(after), area(before), 1e-12 * area(before));
    EXPECT_NEAR(signed_volume(after), signed_volume(before), 1e-12 * signed_volume(before));
    EXPECT_EQ(count_self_intersections(after), 0U);
  }
}

TEST(SplitEdges, AnEdgeJoinsTwoPointsOfATriangle) {
  Surface one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}, {}};
  split_edges(one, {{{0, 1}, {0.25, 0, 0}}, {{0, 2}, {0, 0.25, 0}}});
  const std::vector<Edge> edges = edges_of(one.triangles);
  EXPECT_TRUE(std::binary_search(edges.begin(), edges.end(), Edge{3, 4}));
}

TEST(SplitEdges, PartsKeepTheNames) {
  Surface box = test::box({0, 0, 0}, {1, 2, 3});
  box.known_names = {{"top"}, {"rest"}};
  for (const Triangle& t : box.triangles)
    box.names.push_back(area_vector(box.points, t)[2] > 1e-9 ? 0 : 1);
  split_edges(box, points_on(box, [](int edge) { return edge % 2 == 0; }));
  ASSERT_EQ(box.names.size(), box.triangles.size());
  for (std::size_t t = 0; t < box.names.size(); ++t)
    EXPECT_EQ(box.names[t] == 0, area_vector(box.points, box.triangles[t])[2] > 1e-9);
}

}  // namespace
}  // namespace palpate::mesher
