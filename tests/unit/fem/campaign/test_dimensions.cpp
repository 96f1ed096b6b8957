// SPDX-License-Identifier: AGPL-3.0-or-later
// A campaign in other units: its forces and energies are those of the campaign, in these units.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "fem/campaign/campaign.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

// Powers of two: no digit of the body changes. Roots round otherwise, and the iterations with them.
constexpr double kForce = 1.0 / 64, kLength = 8;

CampaignSettings pressing(const std::string& kind) {
  CampaignSettings s;
  s.materials = {{"tissue", {10e3, 0.45}}};
  ToolGeometry& tool = s.indentation.tool;
  tool.radius = 0.004;
  if (kind == "disc") {
    tool.shape = ToolShape::Disc;
    tool.edge_radius = 0.001;
  } else if (kind == "cylinder") {
    tool.shape = ToolShape::Cylinder;
    tool.length = 0.008;
  }
  if (kind == "no-slip") s.indentation.friction = ToolFriction::NoSlip;
  if (kind == "refined") s.indentation.refine_under_tool = IndentationSettings::kByContact;
  s.indentation.force_tolerance = 1e-7;
  s.indentation.depth = 0.001;
  s.indentation.increments = 4;
  s.indentation.lateral_depths = {0.001};
  s.indentation.lateral_travel = 0.0005;
  s.indentation.lateral_increments = 2;
  s.points = {{{0.0007, -0.0004, 0}, {0, 0, -1}}};
  return s;
}

Body block(double unit) {
  Body body = test::make_block(test::even(-0.012, 0.012, 6), test::even(-0.012, 0.012, 6),
                               test::even(-0.012, 0, 3));
  test::deform(body, [unit](const Vec3& x) { return unit * x; });
  return body;
}

CampaignSettings in_other_units(CampaignSettings s) {
  for (RegionMaterial& material : s.materials)
    material.law.at("young") *= kForce / (kLength * kLength);
  IndentationSettings& press = s.indentation;
  for (double* length : {&press.tool.radius, &press.tool.edge_radius, &press.tool.length,
                         &press.depth, &press.lateral_travel, &press.lateral_depths[0]})
    *length *= kLength;
  s.points[0].position = kLength * s.points[0].position;
  return s;
}

class CampaignDimensions : public testing::TestWithParam<const char*> {};

TEST_P(CampaignDimensions, ACampaignIsTheSameInOtherUnits) {
  const CampaignSettings settings = pressing(GetParam());
  CampaignReport report;
  const SiteCurves here = run_campaign(block(1), settings, report).sites.at(0);
  const SiteCurves there =
      run_campaign(block(kLength), in_other_units(settings), report).sites.at(0);
  ASSERT_EQ(here.status, SiteStatus::Complete) << here.reason;
  ASSERT_EQ(there.paths.size(), here.paths.size());
  for (std::size_t p = 0; p < here.paths.size(); ++p) {
    const auto &a = here.paths[p].samples, &b = there.paths[p].samples;
    ASSERT_EQ(b.size(), a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_LE(norm((1 / kForce) * b[i].force - a[i].force), 1e-6 * norm(a.back().force));
      const double energy = kForce * kLength, whole = 1e-6 * a.back().strain_energy;
      EXPECT_NEAR(b[i].strain_energy / energy, a[i].strain_energy, whole);
      EXPECT_NEAR(b[i].contact_energy / energy, a[i].contact_energy, whole);
      // Between equilibria the force is that of a model, whose factor may be an earlier one.
      EXPECT_NEAR(b[i].tool_work / energy, a[i].tool_work, 100 * whole);
      EXPECT_NEAR(b[i].penetration / kLength, a[i].penetration, 1e-6 * settings.indentation.depth);
      EXPECT_NEAR(b[i].contact_area / (kLength * kLength), a[i].contact_area,
                  1e-6 * a.back().contact_area);
      EXPECT_NEAR(b[i].min_jacobian, a[i].min_jacobian, 1e-6);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Tools, CampaignDimensions,
                         testing::Values("sphere", "no-slip", "disc", "cylinder", "refined"));

}  // namespace
}  // namespace palpate::fem
