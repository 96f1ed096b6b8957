// SPDX-License-Identifier: AGPL-3.0-or-later
// Sites on several cores, many abreast on each, so that they share block solves.
#pragma once

#include <functional>

#include "fem/factor/rest_factor.hpp"

namespace palpate::fem {

/// How many threads work: `lanes` of each core share a SolveBatch, of which one runs at a time.
struct SiteThreads {
  int cores = 1, lanes = 1;
};

/// As many lanes as there are sites for, as a batch takes and as fit into `memory`, bytes (0: no
/// bound), beside a factor in double precision for the site that needs its own.
/// @throws Error(Configuration) when `each`, bytes, does not fit once for each core.
SiteThreads site_threads(const RestFactor& factor, int threads, std::size_t sites, double memory,
                         double each);

/// Calls `work` for every index below `count`, each once, on the threads of a crew. The first
/// exception ends it once the work under way is done, and is passed on.
void parallel_for_sites(const RestFactor& factor, const SiteThreads& size, std::size_t count,
                        const std::function<void(SolveBatch::Member&, std::size_t)>& work);

}  // namespace palpate::fem
