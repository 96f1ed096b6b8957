// SPDX-License-Identifier: AGPL-3.0-or-later
// The campaign on two threads, fast enough for the thread sanitizer.
#include <gtest/gtest.h>

#include <cstring>

#include "fem/campaign/campaign.hpp"
#include "format/to_index.hpp"
#include "tests/support/block_body.hpp"

namespace palpate::fem {
namespace {

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
  ASSERT_EQ(two.sites.size(), 4u);
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

}  // namespace
}  // namespace palpate::fem
