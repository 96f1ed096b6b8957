// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/report/straight_press.hpp"

#include <gtest/gtest.h>

#include "fitting/response/leaning_response.hpp"
#include "runtime/response_curve.hpp"
#include "tests/support/bodies.hpp"

namespace palpate::report {
namespace {

/// g = 170 N/m z and h = 120 N/m rho.
NodeResponse leaning_node(float lean) {
  NodeResponse node = test::wall_response(170, 120);
  node.normal = {{0.0F, 0.01F}, {170.0F, 170.0F}};
  node.lateral = {{0.0F, 0.01F}, {120.0F, 120.0F}};
  node.lean = {lean, 0, 0};
  return node;
}

TEST(StraightPress, HasWhatTheLeanAddsInClosedForm) {
  // Without coupling a press shears by sigma z: F = g + sigma h(sigma z) = (170 + 120 sigma^2) z.
  const ResponseCurve press = straight_press(leaning_node(0.5F), ResponseKind::Decoupled);
  const runtime::CompiledCurve force(press);
  for (const double z : {0.001, 0.0047, 0.01})
    EXPECT_NEAR(force.force(z), (170 + 0.25 * 120) * z, 1e-4 * 200 * z) << z;
}

TEST(StraightPress, IsTheResponseWhereNothingLeans) {
  const NodeResponse node = leaning_node(0);
  const ResponseCurve press = straight_press(node, ResponseKind::Decoupled);
  EXPECT_EQ(press.knot, node.normal.knot);
  EXPECT_EQ(press.slope, node.normal.slope);
}

TEST(StraightPress, FollowsALateralResponseThatStiffensAndGrowsWithDepth) {
  NodeResponse node = leaning_node(0.6F);
  node.normal = {{0.0F, 0.0031F, 0.01F}, {20.0F, 170.0F, 400.0F}};
  node.lateral = {{0.0F, 0.002F, 0.01F}, {120.0F, 150.0F, 700.0F}};
  node.coupling = {0.1F, {{0.0F, 0.004F, 0.01F}, {300.0F, 100.0F, 60.0F}}};
  const runtime::CompiledCurve press(straight_press(node, ResponseKind::Coupled)), g(node.normal);
  const fitting::LeaningResponse leaning(node, ResponseKind::Coupled);
  const double largest = press.force(0.01);
  EXPECT_GT(leaning.normal_force(0.01), 0.05 * g.force(0.01));
  for (int i = 1; i <= 50; ++i) {
    const double z = 0.01 * i / 50;
    EXPECT_NEAR(press.force(z), g.force(z) + leaning.normal_force(z), 1e-3 * largest) << z;
  }
}

}  // namespace
}  // namespace palpate::report
