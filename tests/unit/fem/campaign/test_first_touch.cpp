// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/first_touch.hpp"

#include <gtest/gtest.h>

#include "fem/mesh/to_eigen.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

/// A block whose top is a paraboloid of `curvature`, 1/m, positive for a hollow.
Body curved_top(double curvature) {
  Body body = test::make_block(test::even(-0.01, 0.01, 8), test::even(-0.01, 0.01, 8),
                               test::even(-0.01, 0, 2));
  test::deform(body, [&](const Vec3& x) {
    return Vec3{x[0], x[1],
                x[2] + 0.5 * curvature * (x[0] * x[0] + x[1] * x[1]) * (1 + x[2] / 0.01)};
  });
  return body;
}

CampaignSettings settings() {
  CampaignSettings s;
  s.materials = {{"tissue", {10e3, 0.45}}};
  return s;
}

TEST(FirstTouch, OfABulgeIsAtThePoint) {
  const Body body = curved_top(-20);
  const CampaignContext context(body, settings(), Engine::Direct);
  const std::int32_t site = test::site_nearest(body);
  const FirstTouch touch = first_touch(context, site);
  EXPECT_LT((touch.tool.tip - to_eigen(context.press_point(site).position)).norm(), 1e-12);
  EXPECT_FALSE(touch.facets.empty());
}

/// The hollow is narrower than the sphere of 5 mm: the tool is drawn back until it only touches.
TEST(FirstTouch, OfANarrowHollowIsAboveThePoint) {
  const Body body = curved_top(400);
  const CampaignContext context(body, settings(), Engine::Direct);
  const std::int32_t site = test::site_nearest(body);
  const Eigen::Vector3d point = to_eigen(context.press_point(site).position);
  FirstTouch touch = first_touch(context, site);
  EXPECT_GT((touch.tool.tip - point).dot(-touch.tool.inward), 1e-4);
  const ToolContact contact = contact_at(context, context.model.mesh(), point);
  EXPECT_LE(contact.penetration_of(touch.tool, context.rest), 1e-7 * 0.005);
  touch.tool.tip += 1e-6 * touch.tool.inward;
  EXPECT_GT(contact.penetration_of(touch.tool, context.rest), 0);
}

/// A site with refined elements, before the touch.
struct RefinedSite {
  RefinedSite(const CampaignContext& context, const PressPoint& point)
      : body(site_body_at(context, point, SiteMesh::RefinedWindow)),
        contact(contact_at(context, body.mesh(), context.reference_position(point.position))) {
    SolvePool pool(*context.rest_factor, 1);
    SolvePool::Member member(pool);
    SiteEquilibrium equilibrium(context, body, &member);
    rest = site_at_rest(context, body, contact, equilibrium, point);
  }

  SiteBody body;
  ToolContact contact;
  SiteAtRest rest;
};

/// Elements of half the size sag further than those of the campaign.
TEST(SiteAtRest, OfRefinedElementsIsInEquilibriumWithTheWeight) {
  const Body block = test::make_block(test::even(-0.01, 0.01, 4), test::even(-0.01, 0.01, 4),
                                      test::even(-0.01, 0, 2));
  CampaignSettings s = settings();
  s.gravity = {{0, 20, -60}, 1000};
  s.indentation.refine_under_tool = 1;
  const CampaignContext context(block, s, Engine::SharedFactor);
  const std::int32_t site = test::site_nearest(block);
  const PressPoint point = context.press_point(site);
  const RefinedSite refined(context, point);
  const auto& [body, contact, rest] = refined;
  ASSERT_EQ(rest.failure, "");
  Eigen::VectorXd before, after;
  const SolidModel::State given = body.whole().forces(body.rest(), before);
  body.whole().forces(rest.u, after);
  EXPECT_LT(after.norm(), 1.01e-6 * context.model.weight_norm());
  EXPECT_GT(before.norm(), 1e-4 * context.model.weight_norm());
  EXPECT_LT(rest.state.energy, given.energy);
  // The site is a node of the body, and the tool touches it where it lies.
  const std::int32_t node = block.response.node[to_index(site)];
  const Eigen::Vector3d x = body.mesh().X.col(node) + rest.u.col(node);
  EXPECT_LT((rest.point - x).norm(), 1e-12);
  EXPECT_GT((rest.u.col(node) - body.rest().col(node)).norm(), 1e-6);
  const Tool tool = tool_at_first_touch(context, contact, rest.u, point, rest.point);
  EXPECT_LT((tool.tip - x).norm(), 1e-9);
}

/// A column that leans by half its height, with multipliers of the dilatation: they must follow the
/// displacement from the start.
TEST(SiteAtRest, OfALimpNearlyIncompressibleColumnIsFound) {
  const Body column = test::make_block(test::even(-0.005, 0.005, 2), test::even(-0.005, 0.005, 2),
                                       test::even(-0.05, 0, 10));
  CampaignSettings s = settings();
  s.materials = {{"tissue", {4e3, 0.497}}};
  s.gravity = {{6, 0, -1}, 1000};
  s.indentation.refine_under_tool = 2;
  s.indentation.tool.radius = 0.003;
  const CampaignContext context(column, s, Engine::SharedFactor);
  const double lean = context.rest.row(0).maxCoeff();
  EXPECT_GT(lean, 0.01);
  const PressPoint point = context.press_point(test::site_nearest(column));
  const RefinedSite refined(context, point);
  const SiteAtRest& rest = refined.rest;
  EXPECT_EQ(rest.failure, "");
  Eigen::VectorXd residual;
  refined.body.whole().forces(rest.u, residual);
  EXPECT_LT(residual.norm(), 6e-6 * context.model.weight_norm());
  EXPECT_NEAR(rest.u.row(0).maxCoeff(), lean, 0.1 * lean);
}

}  // namespace
}  // namespace palpate::fem
