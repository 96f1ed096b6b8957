// SPDX-License-Identifier: AGPL-3.0-or-later
// A small indentation with every law: the shared-factor solver against Newton on the whole body,
// the work of the tool against the stored energy, and bodies of two laws.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/at.hpp"
#include "fem/indentation.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/sample_laws.hpp"

namespace palpate::fem {
namespace {

/// A layer of "skin" on "tissue".
Body layered_block() {
  Body body = test::make_block(test::even(-0.016, 0.016, 4), test::even(-0.016, 0.016, 4),
                               test::even(-0.012, 0, 3));
  body.region_names = {"tissue", "skin"};
  for (std::size_t t = 0; t < body.tetrahedra.size(); ++t) {
    double z = 0;
    for (const std::int32_t n : body.tetrahedra[t]) z += 0.25 * body.nodes[at(n)][2];
    body.tetrahedron_region[t] = z > -0.004 ? 1 : 0;
  }
  return body;
}

std::int32_t middle(const Body& body) {
  for (std::size_t v = 0; v < body.response.node.size(); ++v) {
    const Vec3& x = body.nodes[at(body.response.node[v])];
    if (std::hypot(x[0], x[1]) < 1e-9) return static_cast<std::int32_t>(v);
  }
  return -1;
}

CampaignSettings settings_of(const LawConstants& tissue, const LawConstants& skin) {
  CampaignSettings settings;
  settings.materials = {{"tissue", tissue}, {"skin", skin}};
  settings.indentation.tool_radius = 0.008;
  settings.indentation.depth = 0.003;
  settings.indentation.increments = 6;
  settings.indentation.held_depths = {0.002};
  settings.indentation.lateral_travel = 0.0015;
  settings.indentation.lateral_increments = 3;
  return settings;
}

SiteCurves press(const Body& body, const CampaignSettings& settings, Engine engine) {
  const CampaignContext context(body, settings, engine);
  return solve_site(context, middle(body), nullptr);
}

void expect_complete_and_conserving(const SiteCurves& site) {
  ASSERT_EQ(site.status, SiteStatus::Complete) << site.reason;
  for (const CurvePath& path : site.paths) {
    const CurveSample& end = path.samples.back();
    EXPECT_GT(dot(end.force, path.direction), 0);
    EXPECT_NEAR(end.tool_work, end.strain_energy, 0.005 * end.strain_energy);
  }
}

class LawIndentation : public testing::TestWithParam<LawConstants> {};

TEST_P(LawIndentation, ConvergesAsWithNewtonAndConservesEnergy) {
  const Body body = layered_block();
  const CampaignSettings settings = settings_of(GetParam(), GetParam());
  const SiteCurves direct = press(body, settings, Engine::Direct);
  const SiteCurves shared = press(body, settings, Engine::SharedFactor);
  expect_complete_and_conserving(direct);
  expect_complete_and_conserving(shared);
  for (std::size_t p = 0; p < direct.paths.size(); ++p) {
    const Vec3 a = direct.paths[p].samples.back().force, b = shared.paths[p].samples.back().force;
    EXPECT_LT(norm(a - b), 1e-3 * norm(a));
  }
}

TEST_P(LawIndentation, WorksAsASkinOnAnotherLaw) {
  const Body body = layered_block();
  const LawConstants soft(5e3, 0.45);
  const SiteCurves site = press(body, settings_of(soft, GetParam()), Engine::SharedFactor);
  expect_complete_and_conserving(site);
  const SiteCurves soft_alone = press(body, settings_of(soft, soft), Engine::SharedFactor);
  // The skins are all stiffer than the tissue below.
  EXPECT_GT(norm(site.paths[0].samples.back().force),
            norm(soft_alone.paths[0].samples.back().force));
}

INSTANTIATE_TEST_SUITE_P(EveryLaw, LawIndentation, testing::ValuesIn(test::sample_laws(0.45)),
                         [](const auto& instance) {
                           std::string name = instance.param.law;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace palpate::fem
