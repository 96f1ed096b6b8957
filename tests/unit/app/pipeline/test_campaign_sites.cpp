// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/campaign_sites.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "format/error.hpp"

namespace palpate::app {
namespace {

using ::testing::ElementsAre;

Body body_with_sites(std::vector<std::uint8_t> is_site) {
  Body body;
  body.response.is_site.assign(is_site.begin(), is_site.end());
  return body;
}

TEST(CampaignSites, AreTheMarkedVerticesInOrder) {
  EXPECT_THAT(sites_of(body_with_sites({0, 1, 1, 0, 1})), ElementsAre(1, 2, 4));
}

TEST(CampaignSites, ShardsDivideTheSites) {
  const Body body = body_with_sites({1, 1, 1, 0, 1, 1, 1, 1});
  std::vector<std::int32_t> all;
  for (int index = 1; index <= 3; ++index) {
    const auto shard = sites_of_shard(body, {index, 3});
    all.insert(all.end(), shard.begin(), shard.end());
  }
  EXPECT_THAT(sites_of_shard(body, {1, 3}), ElementsAre(0, 4, 7));
  std::sort(all.begin(), all.end());
  EXPECT_EQ(all, sites_of(body));
  EXPECT_EQ(sites_of_shard(body, {1, 1}), sites_of(body));
}

TEST(CampaignSites, RejectMoreShardsThanSites) {
  EXPECT_THROW(sites_of_shard(body_with_sites({1, 0, 1}), {1, 3}), Error);
  EXPECT_NO_THROW(sites_of_shard(body_with_sites({1, 0, 1}), {2, 2}));
}

}  // namespace
}  // namespace palpate::app
