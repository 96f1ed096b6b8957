// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/campaign_cache.hpp"

#include <gtest/gtest.h>

#include "fem/campaign/campaign.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

CampaignSettings heavy_block(GivenShape shape) {
  CampaignSettings settings;
  settings.materials = {{"tissue", {8e3, 0.45}}};
  settings.gravity = {{0, 0, -9.81}, 1000, shape};
  settings.indentation = {.tool = {.radius = 0.005}, .depth = 0.001, .increments = 2};
  settings.indentation.lateral_depths.clear();
  return settings;
}

/// A campaign, and the steps towards its equilibrium under the weight.
struct Pressed {
  Pressed(const Body& body, CampaignSettings settings, CampaignCache* cache) {
    settings.preloading = [this](const PreloadProgress& p) { steps = p.steps; };
    CampaignReport report;
    curves = run_campaign(body, settings, report, cache);
  }

  int steps = 0;
  Curves curves;
};

class CampaignCacheTest : public testing::TestWithParam<GivenShape> {
 protected:
  const Body body_ = test::make_block(test::even(-0.02, 0.02, 4), test::even(-0.02, 0.02, 4),
                                      test::even(0, 0.02, 2));
};

TEST_P(CampaignCacheTest, KeepsTheStateUnderTheWeight) {
  const CampaignSettings settings = heavy_block(GetParam());
  CampaignCache cache;
  const Pressed first(body_, settings, &cache), again(body_, settings, &cache),
      alone(body_, settings, nullptr);
  EXPECT_GT(first.steps, 0);
  EXPECT_EQ(again.steps, 0);
  EXPECT_EQ(alone.steps, first.steps);
  ASSERT_EQ(again.curves.sites.size(), alone.curves.sites.size());
  for (std::size_t i = 0; i < again.curves.sites.size(); ++i) {
    const CurveSample &a = again.curves.sites[i].paths.front().samples.back(),
                      &b = alone.curves.sites[i].paths.front().samples.back();
    ASSERT_EQ(a.force, b.force);
  }
}

TEST_P(CampaignCacheTest, ComputesItAnewForAnotherBodyUnderItsWeight) {
  const CampaignSettings settings = heavy_block(GetParam());
  CampaignCache cache;
  const auto is_computed = [&](const CampaignSettings& changed) {
    cache = {};
    const Pressed first(body_, settings, &cache), second(body_, changed, &cache);
    return second.steps > 0;
  };
  EXPECT_FALSE(is_computed(settings));
  CampaignSettings changed = settings;
  changed.gravity.density = 1100;
  EXPECT_TRUE(is_computed(changed));
  changed = settings;
  changed.gravity.acceleration = {1, 0, -9};
  EXPECT_TRUE(is_computed(changed));
  changed = settings;
  changed.materials[0].law.at("young") = 9e3;
  EXPECT_TRUE(is_computed(changed));
  changed = settings;
  changed.materials[0].density = 900;
  EXPECT_TRUE(is_computed(changed));
  changed = settings;
  changed.dilatation = Dilatation::Pointwise;
  EXPECT_TRUE(is_computed(changed));
}

INSTANTIATE_TEST_SUITE_P(Shapes, CampaignCacheTest,
                         testing::Values(GivenShape::Unloaded, GivenShape::Loaded),
                         [](const auto& instance) {
                           return instance.param == GivenShape::Loaded ? "Loaded" : "Unloaded";
                         });

}  // namespace
}  // namespace palpate::fem
