// SPDX-License-Identifier: AGPL-3.0-or-later
// A small indentation with every law: the shared-factor solver against Newton on the whole body,
// the work of the tool against the stored energy, and bodies of two laws.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/campaign/bonded_patch.hpp"
#include "fem/campaign/indentation.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"
#include "tests/support/patch_work.hpp"
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
    for (const std::int32_t n : body.tetrahedra[t]) z += 0.25 * body.nodes[to_index(n)][2];
    body.tetrahedron_region[t] = z > -0.004 ? 1 : 0;
  }
  return body;
}

CampaignSettings settings_of(const LawConstants& tissue, const LawConstants& skin) {
  CampaignSettings settings;
  settings.materials = {{"tissue", tissue}, {"skin", skin}};
  settings.indentation.tool.radius = 0.008;
  settings.indentation.depth = 0.002;
  settings.indentation.increments = 4;
  settings.indentation.lateral_depths = {0.001};
  settings.indentation.lateral_travel = 0.001;
  settings.indentation.lateral_increments = 2;
  return settings;
}

SiteCurves press(const Body& body, const CampaignSettings& settings, Engine engine) {
  const CampaignContext context(body, settings, engine);
  SiteCurves site = solve_site(context, test::site_nearest(body), nullptr);
  EXPECT_EQ(site.status, SiteStatus::Complete) << site.reason;
  return site;
}

double end_force(const SiteCurves& site) {
  return norm(site.paths.front().samples.back().force);
}

/// Saint Venant-Kirchhoff loses strong ellipticity under the tool before 2 mm.
CampaignSettings bearable(const LawConstants& tissue, const LawConstants& skin) {
  CampaignSettings settings = settings_of(tissue, skin);
  if (skin.law == "saint-venant-kirchhoff") settings.indentation.depth = 0.0015;
  return settings;
}

class LawIndentation : public testing::TestWithParam<LawConstants> {};

TEST_P(LawIndentation, ConvergesAsWithNewton) {
  const Body body = layered_block();
  const CampaignSettings settings = bearable(GetParam(), GetParam());
  const SiteCurves direct = press(body, settings, Engine::Direct);
  const SiteCurves shared = press(body, settings, Engine::SharedFactor);
  ASSERT_EQ(direct.paths.size(), shared.paths.size());
  for (std::size_t p = 0; p < direct.paths.size(); ++p) {
    const Vec3 a = direct.paths[p].samples.back().force, b = shared.paths[p].samples.back().force;
    EXPECT_LT(norm(a - b), 1e-3 * norm(a));
    EXPECT_GT(dot(a, direct.paths[p].direction), 0);
  }
}

TEST_P(LawIndentation, WorksAsASkinOnAnotherLaw) {
  const Body body = layered_block();
  const LawConstants soft(4e3, 0.45);
  CampaignSettings settings = bearable(soft, GetParam());
  settings.indentation.lateral_depths.clear();
  const double layered = end_force(press(body, settings, Engine::SharedFactor));
  settings.materials[0].law = GetParam();
  const double stiff = end_force(press(body, settings, Engine::SharedFactor));
  settings.materials = {{"tissue", soft}, {"skin", soft}};
  const double alone = end_force(press(body, settings, Engine::SharedFactor));
  EXPECT_GT(layered, 1.05 * alone);
  EXPECT_LT(layered, 0.95 * stiff);
}

TEST_P(LawIndentation, StoresTheWorkDoneOnABondedPatch) {
  const Body body = layered_block();
  CampaignSettings settings = bearable(GetParam(), GetParam());
  settings.indentation.increments = 8;
  const PatchCurve curve = press_patch(body, settings, test::site_nearest(body), 0.0041);
  test::expect_work_is_stored(curve);
}

INSTANTIATE_TEST_SUITE_P(EveryLaw, LawIndentation, testing::ValuesIn(test::sample_laws(0.45)),
                         [](const auto& instance) {
                           std::string name = instance.param.law;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace palpate::fem
