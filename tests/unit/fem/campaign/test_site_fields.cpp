// SPDX-License-Identifier: AGPL-3.0-or-later
// What the campaign keeps of the skin, against the states of the same body solved by themselves.
#include "fem/campaign/site_fields.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "fem/campaign/campaign.hpp"
#include "fem/campaign/indentation.hpp"
#include "format/sha256.hpp"
#include "format/site_record.hpp"
#include "format/skin_mesh.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

CampaignSettings field_settings() {
  CampaignSettings s;
  s.materials = {{"tissue", {10e3, 0.49}}};
  s.indentation.depth = 0.004;
  s.indentation.increments = 8;
  s.indentation.lateral_depths = {0.002};
  s.indentation.lateral_travel = 0.001;
  s.indentation.lateral_increments = 4;
  return s;
}

TEST(SiteFieldsOfCampaign, DepthsAreIncrementsCloserTogetherNearTheTouch) {
  IndentationSettings settings;
  settings.depth = 0.006;
  settings.increments = 12;
  const auto depths = field_depths(settings, 4);
  const std::vector<double> expected{0.0005, 0.0015, 0.0035, 0.006};
  ASSERT_EQ(depths.size(), expected.size());
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(depths[i], expected[i], 1e-12);
  settings.increments = 2;
  EXPECT_EQ(field_depths(settings, 4), (std::vector<double>{0.003, 0.006}));
  settings.increments = 5;  // the first two of four are nearest to the same increment
  EXPECT_EQ(field_depths(settings, 4).size(), 4U);
  EXPECT_TRUE(field_depths(settings, 0).empty());
}

TEST(SiteFieldsOfCampaign, AreTheDisplacementsOfTheSkin) {
  const Body body = test::make_block(test::graded(0.03, 0.005, 0.0025, 1.5),
                                     test::graded(0.03, 0.005, 0.0025, 1.5),
                                     {-0.03, -0.02, -0.012, -0.006, -0.003, 0});
  const std::int32_t site = test::site_nearest(body);
  const SkinMesh skin = skin_mesh(body);
  CampaignSettings settings = field_settings();
  settings.sites = {site};
  CampaignReport report;
  const Curves without = run_campaign(body, settings, report);
  std::vector<SiteFields> kept;
  settings.field_depths = 3;
  settings.fields = [&](SiteFields fields) { kept.push_back(std::move(fields)); };
  const Curves with = run_campaign(body, settings, report);
  EXPECT_EQ(content_sha256(with), content_sha256(without));  // the curves are as they were

  ASSERT_EQ(kept.size(), 1U);
  const SiteFields& fields = kept.front();
  EXPECT_EQ(fields.vertex, site);
  EXPECT_EQ(fields.curves, sha256(site_bytes(with.sites.front())));
  ASSERT_EQ(fields.normal.size(), 3U);
  const auto at = [&](const std::vector<float>& u, std::size_t w) {
    return Vec3{static_cast<double>(u[3 * w]), static_cast<double>(u[3 * w + 1]),
                static_cast<double>(u[3 * w + 2])};
  };
  const auto contact = to_index(skin.vertex_of[to_index(site)]);
  // To the size of the elements: the tool rests on the skin between its corners.
  for (const NormalField& field : fields.normal)
    EXPECT_NEAR(at(field.skin, contact)[2], -field.depth, 0.02 * 0.004);
  // The end of the path, solved by itself.
  const DeformedState direct = deformed_state(body, field_settings(), site);
  for (std::size_t w = 0; w < skin.node.size(); ++w)
    EXPECT_LT(norm(at(fields.normal.back().skin, w) - direct.displacement[to_index(skin.node[w])]),
              1e-6);
  // Fixed nodes stay.
  for (std::size_t w = 0; w < skin.node.size(); ++w)
    if (skin.positions[w][2] < -0.0299) {
      EXPECT_EQ(norm(at(fields.normal.back().skin, w)), 0);
    }

  // Along the path of the curves and across it; the contact point does not slip on the tool.
  ASSERT_EQ(fields.lateral.size(), 2U);
  EXPECT_NEAR(dot(fields.lateral[0].direction, fields.lateral[1].direction), 0, 1e-12);
  EXPECT_NEAR(fields.lateral[0].travel, 0.001, 1e-12);
  for (const LateralField& field : fields.lateral) {
    EXPECT_EQ(field.depth, 0.002);
    EXPECT_LT(norm(at(field.skin, contact) - field.travel * field.direction), 2e-5);
  }
}

TEST(SiteFieldsOfCampaign, StatesThatFrictionHoldsAreKeptBesideTheEnds) {
  const Body body = test::make_block(test::graded(0.03, 0.005, 0.0025, 1.5),
                                     test::graded(0.03, 0.005, 0.0025, 1.5),
                                     {-0.03, -0.02, -0.012, -0.006, -0.003, 0});
  CampaignSettings settings = field_settings();
  settings.indentation.lateral_depths = {0.0015};  // not among the depths of the fields
  settings.indentation.azimuths = {0, 1};
  settings.sites = {test::site_nearest(body)};
  settings.field_depths = 1;
  std::vector<SiteFields> kept;
  settings.fields = [&](SiteFields fields) { kept.push_back(std::move(fields)); };
  CampaignReport report;
  run_campaign(body, settings, report);
  // The lateral force over that of the press at the four increments of both paths.
  std::vector<double> ratios;
  const Curves curves = run_campaign(body, settings, report);
  for (const CurvePath& path : curves.sites.front().paths)
    for (const CurveSample& sample : path.samples)
      if (path.kind == PathKind::Lateral && sample.displacement > 0)
        ratios.push_back(std::hypot(sample.force[0], sample.force[1]) / -sample.force[2]);
  ASSERT_EQ(ratios.size(), 8U);
  settings.field_friction = 0.5 * (ratios[1] + ratios[2]);  // between the second and the third
  ASSERT_LT(ratios[5], *settings.field_friction);
  ASSERT_GT(ratios[6], *settings.field_friction);
  run_campaign(body, settings, report);
  const SiteFields &ends = kept.front(), &all = kept.back();

  ASSERT_EQ(ends.normal.size(), 1U);
  ASSERT_EQ(all.normal.size(), 2U);
  EXPECT_DOUBLE_EQ(all.normal[0].depth, 0.0015);
  EXPECT_EQ(all.normal[1].skin, ends.normal[0].skin);
  ASSERT_EQ(ends.lateral.size(), 2U);
  ASSERT_EQ(all.lateral.size(), 6U);
  const std::vector<int> increments{1, 2, 4};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(all.lateral[i].direction, ends.lateral[i / 3].direction);
    EXPECT_NEAR(all.lateral[i].travel, 0.00025 * increments[i % 3], 1e-12);
  }
  EXPECT_EQ(all.lateral[2].skin, ends.lateral[0].skin);
  EXPECT_EQ(all.lateral[5].skin, ends.lateral[1].skin);
}

/// Wider than broad, so that the directions differ.
Body lopsided_block() {
  return test::make_block(test::graded(0.03, 0.005, 0.0025, 1.5),
                          test::graded(0.02, 0.005, 0.0025, 1.5),
                          {-0.02, -0.012, -0.006, -0.003, 0});
}

std::vector<SiteFields> fields_of(const Body& body, CampaignSettings settings) {
  std::vector<SiteFields> kept;
  settings.sites = {test::site_nearest(body)};
  settings.field_depths = 1;
  settings.fields = [&](SiteFields fields) { kept.push_back(std::move(fields)); };
  CampaignReport report;
  run_campaign(body, settings, report);
  return kept;
}

/// u per metre of lateral deflection.
Eigen::Map<const Eigen::VectorXf> skin_of(const LateralField& field) {
  return {field.skin.data(), static_cast<Eigen::Index>(field.skin.size())};
}

TEST(SiteFieldsOfCampaign, TheOneAcrossIsThatOfAPathOfItsOwn) {
  const Body body = lopsided_block();
  CampaignSettings settings = field_settings();
  settings.indentation.increments = 4;
  const auto across = fields_of(body, settings).front().lateral.at(1);
  settings.indentation.azimuths = {0, std::acos(0.0)};
  settings.indentation.lateral_travel = across.travel;
  const auto direct = fields_of(body, settings).front().lateral.at(1);
  ASSERT_NEAR(dot(across.direction, direct.direction), 1, 1e-12);
  ASSERT_NEAR(across.travel, direct.travel, 1e-12);
  const Eigen::VectorXf expected = skin_of(direct) / static_cast<float>(direct.travel);
  const Eigen::VectorXf found = skin_of(across) / static_cast<float>(across.travel);
  EXPECT_LT((found - expected).norm(), 0.01F * expected.norm());
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 0.03F);  // of the deflection
}

/// What the solver does for the picture, beside what it does for the forces.
TEST(SiteFieldsOfCampaign, TheOneAcrossCostsATenthOfTheSite) {
  const Body body = lopsided_block();
  const CampaignContext context(body, field_settings(), Engine::SharedFactor);
  SolvePool pool(*context.rest_factor, 1);
  SolvePool::Member member(pool);
  SiteSolver solver(context, &member);
  int across = 0, all = 0;
  Vec3 along{};
  solver.also_across(true);
  solver.observe_lateral([&](const LateralPlan& plan, const ToolContact&, const Displacement&,
                             const CurveSample& sample) {
    if (norm(along) == 0) along = plan.direction;
    if (std::abs(dot(along, plan.direction)) < 0.5) across += sample.iterations;
  });
  for (const CurvePath& path : solver.solve(test::site_nearest(body)).paths)
    for (const CurveSample& sample : path.samples) all += sample.iterations;
  EXPECT_GT(across, 0);
  EXPECT_LE(across, 0.1 * all);
}

}  // namespace
}  // namespace palpate::fem
