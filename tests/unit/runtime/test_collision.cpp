// SPDX-License-Identifier: AGPL-3.0-or-later
// The tree against every triangle tested one by one, and the projection against its definition.
#include "runtime/collision.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "runtime/local_model.hpp"
#include "tests/support/bodies.hpp"

namespace palpate::test {
namespace {

using runtime::CollisionTree;
using runtime::Element;
using runtime::kNoElement;
using runtime::LocalModel;
using runtime::Surface;
using runtime::SurfacePoint;

/// Position on the segment of the first crossing into the body, by signed volumes; 2 when none.
double first_entry_by_volumes(const Surface& surface, const Vec3& p, const Vec3& q) {
  const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return dot(cross(b - a, c - a), d - a);
  };
  double first = 2;
  for (std::int32_t m = 0; m < surface.element_count(); ++m) {
    const Element& e = surface.element(m);
    if (!e.active) continue;
    const Vec3 a = surface.vertex(e, 0);
    const Vec3 b = surface.vertex(e, 1);
    const Vec3 c = surface.vertex(e, 2);
    const double from = volume(a, b, c, p);
    const double to = volume(a, b, c, q);
    if (!(from > 0 && to < 0)) continue;  // outside is the positive side
    const bool inside = volume(p, q, b, a) > 0 && volume(p, q, c, b) > 0 && volume(p, q, a, c) > 0;
    const bool outside = volume(p, q, b, a) < 0 && volume(p, q, c, b) < 0 && volume(p, q, a, c) < 0;
    if (inside || outside) first = std::min(first, from / (from - to));
  }
  return first;
}

TEST(CollisionTree, FindsTheFirstEntryThatAnExhaustiveSearchFinds) {
  Library library = bumpy_sphere(3, 0.03, 0.3, uniform);
  library.responses[100] = {};  // a hole in it
  const Surface surface(library);
  const CollisionTree tree(surface);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-0.045, 0.045);
  int hits = 0;
  for (int trial = 0; trial < 10000; ++trial) {
    const Vec3 p{any(random), any(random), any(random)};
    const double reach = trial % 2 == 0 ? 1.0 : 0.1;
    const Vec3 q = p + reach * Vec3{any(random), any(random), any(random)};
    const double expected = first_entry_by_volumes(surface, p, q);
    const SurfacePoint found = tree.first_entry(p, q);
    ASSERT_EQ(found.element != kNoElement, expected <= 1) << trial;
    if (expected > 1) continue;
    ++hits;
    EXPECT_NEAR(norm(surface.position(found) - (p + expected * (q - p))), 0, 1e-12);
  }
  EXPECT_GT(hits, 500);
}

TEST(CollisionTree, ASegmentThroughAnEdgeOrAVertexIsNotLost) {
  const Surface surface(plate(6, 0.06, uniform));
  const CollisionTree tree(surface);
  for (int i = 1; i < 12; ++i) {
    for (int j = 1; j < 12; ++j) {  // every second one on a vertex, the others on edges
      const Vec3 above{0.005 * i, 0.005 * j, 0.001};
      const Vec3 below{0.005 * i, 0.005 * j, -0.0013};
      EXPECT_NE(tree.first_entry(above, below).element, kNoElement) << i << " " << j;
      EXPECT_EQ(tree.first_entry(below, above).element, kNoElement);
    }
  }
}

TEST(CollisionTree, AStepThatBeginsOnTheSurfaceEnters) {
  const Surface surface(plate(6, 0.06, uniform));
  const CollisionTree tree(surface);
  const Vec3 on{0.0213, 0.0371, 0};
  EXPECT_NE(tree.first_entry(on, on - Vec3{0, 0, 1e-6}).element, kNoElement);
  EXPECT_EQ(tree.first_entry(on + Vec3{0, 0, 1e-3}, on).element,
            kNoElement);  // touching is outside
}

TEST(CollisionTree, TheNearestPointMeetsTheConditionsOfAMinimum) {
  Library library = bumpy_sphere(3, 0.03, 0.3, uniform);
  library.responses[100] = {};
  const Surface surface(library);
  const CollisionTree tree(surface);
  std::vector<std::int32_t> all;
  for (std::int32_t m = 0; m < surface.element_count(); ++m)
    if (surface.element(m).active) all.push_back(m);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> any(-0.045, 0.045);
  int on_edges = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Vec3 x{any(random), any(random), any(random)};
    const SurfacePoint found = tree.nearest(x, 1);
    ASSERT_NE(found.element, kNoElement);
    const Vec3 p = surface.position(found);
    const Vec3& n = found.natural;
    EXPECT_NEAR(n[0] + n[1] + n[2], 1, 1e-12);
    EXPECT_GE(std::min({n[0], n[1], n[2]}), 0);
    on_edges += std::min({n[0], n[1], n[2]}) == 0 ? 1 : 0;
    // Over its own triangle, which is convex, no corner lies on the side of x ...
    for (std::size_t l = 0; l < 3; ++l)
      EXPECT_LE(dot(x - p, surface.vertex(surface.element(found.element), l) - p), 1e-15);
    // ... and no corner of another is nearer.
    for (const std::int32_t m : all)
      for (std::size_t l = 0; l < 3; ++l)
        ASSERT_GE(norm(surface.vertex(surface.element(m), l) - x), norm(p - x) - 1e-15);
    EXPECT_NEAR(norm(surface.position(nearest(surface, all, x, 1)) - p), 0, 1e-15);
    EXPECT_EQ(tree.nearest(x, 0.999 * norm(p - x)).element, kNoElement);
  }
  EXPECT_GT(on_edges, 300);
}

TEST(Projection, EndsWhereTheTipLiesAlongTheInterpolatedDirection) {
  const Surface surface(bumpy_sphere(3, 0.03, 0.15, uniform));
  const CollisionTree tree(surface);
  std::mt19937 random(5);
  std::normal_distribution<double> any;
  for (int trial = 0; trial < 2000; ++trial) {
    Vec3 out{any(random), any(random), any(random)};
    out = (1.0 / norm(out)) * out;
    const SurfacePoint entry = tree.first_entry(0.05 * out, Vec3{});
    ASSERT_NE(entry.element, kNoElement);
    const Vec3 x = surface.position(entry) - 0.001 * out;
    const runtime::Projection p = project(surface, entry, x, 24, 1e-11);
    EXPECT_LE(p.lateral, 1e-11);
    const Vec3 r = x - surface.position(p.point);
    EXPECT_LE(norm(cross(r, surface.normal(p.point))), 2e-11);
    EXPECT_GT(dot(r, surface.normal(p.point)), 0);
  }
}

}  // namespace
}  // namespace palpate::test
