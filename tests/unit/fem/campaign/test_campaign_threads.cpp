// SPDX-License-Identifier: AGPL-3.0-or-later
// The campaign on two threads, fast enough for the thread sanitizer.
#include <gtest/gtest.h>

#include <cstring>

#include "fem/campaign/campaign.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

/// The curves of two campaigns have the same bits.
void expect_same_bits(const Curves& one, const Curves& two) {
  ASSERT_EQ(one.sites.size(), two.sites.size());
  for (std::size_t i = 0; i < one.sites.size(); ++i) {
    EXPECT_EQ(one.sites[i].status, SiteStatus::Complete) << one.sites[i].reason;
    ASSERT_EQ(one.sites[i].paths.size(), two.sites[i].paths.size());
    for (std::size_t p = 0; p < one.sites[i].paths.size(); ++p) {
      const auto &a = one.sites[i].paths[p].samples, &b = two.sites[i].paths[p].samples;
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t s = 0; s < a.size(); ++s)
        EXPECT_EQ(std::memcmp(&a[s].force, &b[s].force, sizeof a[s].force), 0);
    }
  }
}

TEST(CampaignThreads, TwoGiveTheBitsOfOne) {
  const Body body = test::make_block(test::even(-0.015, 0.015, 4), test::even(-0.015, 0.015, 4),
                                     test::even(-0.015, 0, 2));
  CampaignSettings settings;
  settings.materials = {{"tissue", {10e3, 0.45}}};
  settings.indentation.depth = 0.001;
  settings.indentation.increments = 2;
  settings.indentation.lateral_depths = {0.001};
  settings.indentation.lateral_travel = 0.0005;
  settings.indentation.lateral_increments = 1;
  for (std::int32_t v = 0; v < 25 && settings.sites.size() < 4; ++v)
    if (body.response.is_site[to_index(v)]) settings.sites.push_back(v);
  std::int64_t reported = 0;
  settings.progress = [&](const CampaignProgress& progress) { reported += progress.done; };
  CampaignReport report;
  const Curves one = run_campaign(body, settings, report);
  settings.threads = 2;
  const Curves two = run_campaign(body, settings, report);
  EXPECT_EQ(reported, 2 * (1 + 2 + 3 + 4));  // from one thread at a time
  ASSERT_EQ(one.sites.size(), 4u);
  expect_same_bits(one, two);
}

/// On a thin plate sites go on with a factor of their own, after 15 steps of an increment.
TEST(CampaignThreads, TwoGiveTheBitsOfOneWhereSitesHaveFactorsOfTheirOwn) {
  const Body plate = test::make_block(test::even(-0.002, 0, 1), test::even(-0.008, 0.008, 3),
                                      test::even(0, 0.032, 8));
  CampaignSettings settings;
  settings.materials = {{"tissue", {10e3, 0.45}}};
  settings.indentation.tool.radius = 0.006;
  settings.indentation.depth = 0.004;
  settings.indentation.increments = 2;
  settings.indentation.lateral_depths.clear();
  for (const double y : {-0.003, -0.001, 0.001, 0.004})
    settings.points.push_back({{0, y, 0.027}, {-1, 0, 0}});
  CampaignReport report;
  const Curves one = run_campaign(plate, settings, report);
  settings.threads = 2;
  expect_same_bits(one, run_campaign(plate, settings, report));
  for (const SiteCurves& site : one.sites) EXPECT_GT(site.paths[0].samples[1].iterations, 15);
}

}  // namespace
}  // namespace palpate::fem
