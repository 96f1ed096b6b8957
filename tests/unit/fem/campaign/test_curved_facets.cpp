// SPDX-License-Identifier: AGPL-3.0-or-later
// The stiffness of a ball does not depend on the position. With flat facets it does: a node
// protrudes from the chords around it, and the middle of a facet lies below the ball.
#include <gtest/gtest.h>

#include "tests/support/prism_body.hpp"
#include "tests/support/round_cap.hpp"

namespace palpate::fem {
namespace {

TEST(CurvedFacets, MakeTheStiffnessOfABallIndependentOfThePosition) {
  const test::RoundCap cap;
  IndentationSettings press;
  press.tool.radius = 0.005;
  press.depth = 0.0015;
  press.increments = 3;
  press.refine_under_tool = 1;
  Body body = test::even_cap(cap, 0.005);
  const auto flat = test::spread_of_force(cap, body, press, 0.0075);
  test::curve_onto_sphere(cap.radius, body);
  const auto curved = test::spread_of_force(cap, body, press, 0.0075);
  EXPECT_LT(curved[0].deviation, 0.04);  // at 0.5 mm, with a contact of 1.5 mm
  EXPECT_LT(curved[2].deviation, 0.01);
  for (const std::size_t i : {0U, 2U}) EXPECT_LT(3 * curved[i].deviation, flat[i].deviation);
}

}  // namespace
}  // namespace palpate::fem
