// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gtest/gtest.h>

#include "mesher/skin/curved_skin.hpp"

namespace palpate::mesher {
namespace {

// A tetrahedron of height h over its face: a bulge inward of more than a fraction of h would
// invert a part of it.
TEST(CurvedSkin, BulgesAreReducedWhereAnElementWouldBeInverted) {
  Body body;
  body.nodes = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0.002, 0.002, -0.001}};
  body.tetrahedra = {{0, 2, 1, 3}};
  body.boundary = {{0, 1, 2}};
  const Vec3 straight{0.005, 0, 0};
  for (const double bulge : {0.00005, -0.00005}) {
    body.curved_edges = {{{0, 1}, straight + Vec3{0, 0, bulge}}};
    EXPECT_EQ(reduce_bulges(body), 0U);
    EXPECT_EQ(body.curved_edges[0].middle[2], bulge);
  }
  body.curved_edges = {{{0, 1}, straight + Vec3{0, 0, -0.0018}}};
  EXPECT_EQ(reduce_bulges(body), 1U);
  ASSERT_EQ(body.curved_edges.size(), 1U);
  EXPECT_LT(body.curved_edges[0].middle[2], 0);
  EXPECT_GE(body.curved_edges[0].middle[2], -0.0018 / 2);
  body.curved_edges = {{{0, 1}, straight + Vec3{0, 0, -1}}};
  EXPECT_EQ(reduce_bulges(body), 1U);
  EXPECT_TRUE(body.curved_edges.empty());
}

// No reduction makes the element valid; the loop must end nevertheless.
TEST(CurvedSkin, ReductionEndsOnADegenerateElement) {
  Body body;
  body.nodes = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0.004, 0.004, 1e-19}};
  body.tetrahedra = {{0, 2, 1, 3}};
  body.boundary = {{0, 1, 2}};
  body.curved_edges = {{{0, 1}, {0.005, 0, 0.0001}}};
  EXPECT_EQ(reduce_bulges(body), 1U);
  EXPECT_TRUE(body.curved_edges.empty());
}

}  // namespace
}  // namespace palpate::mesher
