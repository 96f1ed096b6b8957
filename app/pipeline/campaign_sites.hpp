// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "app/pipeline/workspace.hpp"
#include "format/body.hpp"

namespace palpate::app {

/// All sites of a body, ascending.
std::vector<std::int32_t> sites_of(const Body& body);

/// Every count-th site from the index-th, so that regions with slow sites are spread over the
/// shards. @throws Error(Configuration) when there are more shards than sites.
std::vector<std::int32_t> sites_of_shard(const Body& body, const Shard& shard);

}  // namespace palpate::app
