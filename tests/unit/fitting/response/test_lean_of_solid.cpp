// SPDX-License-Identifier: AGPL-3.0-or-later
// Beside a free side of a block: drags from two depths of a press foretell how a tool that sticks
// shears the solid, at every depth, and a fit renders it. It is softer towards the free side.
#include <gtest/gtest.h>

#include "fem/campaign/campaign.hpp"
#include "fitting/response/fit.hpp"
#include "fitting/response/lean.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fitting {
namespace {

constexpr double kDepth = 0.004;

Body beside_a_side() {
  return test::make_block(
      {-0.012, -0.008, -0.005, -0.003, -0.001, 0.001, 0.003, 0.006, 0.012, 0.03},
      test::graded(0.03, 0.005, 0.0025, 1.5), {-0.03, -0.02, -0.012, -0.006, -0.003, 0});
}

fem::CampaignSettings settings(const Body& body) {
  fem::CampaignSettings s;
  s.materials = {{"tissue", {10e3, 0.47}}};
  s.sites = {test::site_nearest(body, -0.001)};
  s.indentation.depth = kDepth;
  s.indentation.increments = 5;
  s.indentation.lateral_depths = {0.3 * kDepth, 0.8 * kDepth};
  s.indentation.lateral_travel = 0.4 * kDepth;
  s.indentation.lateral_increments = 3;
  s.indentation.drag_across = true;
  return s;
}

Curves solved(const Body& body, const fem::CampaignSettings& s) {
  fem::CampaignReport report;
  Curves curves = fem::run_campaign(body, s, report);
  EXPECT_EQ(curves.sites.front().status, SiteStatus::Complete) << curves.sites.front().reason;
  return curves;
}

TEST(LeanOfSolid, IsThatOfAPressThatSticks) {
  const Body body = beside_a_side();
  fem::CampaignSettings campaign = settings(body);
  campaign.indentation.friction = fem::ToolFriction::NoSlip;
  fem::CampaignSettings fine = campaign;
  fine.indentation.increments = 32;
  fine.indentation.lateral_depths.clear();
  fem::CampaignSettings slipping = fine;
  slipping.indentation.friction = fem::ToolFriction::Frictionless;
  const Curves curves = solved(body, campaign), direct = solved(body, fine);

  FitSettings fitting;
  fitting.kind = ResponseKind::Coupled;
  const auto vertex = to_index(campaign.sites.front());
  const NodeResponse node = fit(body, curves, fitting).responses[vertex];
  const LeaningResponse lean(node, ResponseKind::Coupled);
  const Vec3 inward = body.response.inward[vertex];
  NodeResponse dragged = node;
  const auto of_drags = lean_of_drags(curves.sites.front(), inward, node, ResponseKind::Coupled);
  ASSERT_TRUE(of_drags);
  for (std::size_t i = 0; i < 3; ++i) dragged.lean[i] = static_cast<float>((*of_drags)[i]);
  const LeaningResponse foretold(dragged, ResponseKind::Coupled);
  const auto transverse = [&](const CurveSample& sample) {
    return sample.force - dot(sample.force, inward) * inward;
  };
  for (const CurveSample& sample : direct.sites.front().paths.front().samples) {
    if (sample.displacement < 0.3 * kDepth) continue;
    const Vec3 sheared = transverse(sample);
    EXPECT_GT(norm(sheared), 0.04 * norm(sample.force));
    const auto error_of = [&](const LeaningResponse& response) {
      return norm(response.transverse_force(sample.displacement) - sheared);
    };
    EXPECT_LT(error_of(foretold), 0.12 * norm(sheared)) << sample.displacement;
    EXPECT_LT(error_of(lean), 0.01 * norm(sample.force)) << sample.displacement;
  }
  // The press without friction does not show it.
  const Vec3 end = transverse(solved(body, slipping).sites.front().paths.front().samples.back());
  EXPECT_LT(norm(end), 0.5 * norm(lean.transverse_force(kDepth)));
}

}  // namespace
}  // namespace palpate::fitting
