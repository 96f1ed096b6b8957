// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/campaign_sites.hpp"

#include <string>

#include "format/error.hpp"

namespace palpate::app {

std::vector<std::int32_t> sites_of(const Body& body) {
  std::vector<std::int32_t> sites;
  for (std::size_t v = 0; v < body.response.is_site.size(); ++v)
    if (body.response.is_site[v] != 0) sites.push_back(static_cast<std::int32_t>(v));
  return sites;
}

std::vector<std::int32_t> sites_of_shard(const Body& body, const Shard& shard) {
  const std::vector<std::int32_t> all = sites_of(body);
  const auto count = static_cast<std::size_t>(shard.count);
  if (count > all.size() && count > 1)
    throw Error(
        ErrorKind::Configuration, "--shard",
        std::to_string(shard.count) + " shards for " + std::to_string(all.size()) + " sites",
        "use at most as many shards as sites");
  std::vector<std::int32_t> mine;
  for (std::size_t i = static_cast<std::size_t>(shard.index) - 1; i < all.size(); i += count)
    mine.push_back(all[i]);
  return mine;
}

}  // namespace palpate::app
