// SPDX-License-Identifier: AGPL-3.0-or-later
// Sites on several cores, more at a time than there are cores, so that they share block solves.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "fem/campaign/settings.hpp"
#include "fem/factor/solve_pool.hpp"

namespace palpate::fem {

/// How many sites have a thread, and how many of these run at a time (SolvePool).
struct SiteThreads {
  int cores = 1, threads = 1;
};

/// How many sites may have a factor of their own at once: one for each core, and all together no
/// more than a quarter of `memory`, bytes (0: that of the machine), but one in any case.
int places_for_own_factors(const RestFactor& factor, int cores, double memory);

/// How many sites run for each core: as many as fill a block solve. Where elements are refined more
/// than once, block solves of a body of few unknowns take a tenth of the time, and few sites at a
/// time save memory.
int sites_for_each_core(const IndentationSettings& indentation, int unknowns);

/// As many threads as there are sites, at most `most_per_core` for each core, and no more than fit
/// into `memory`, bytes (0: no bound), beside the factors that sites need of their own.
/// `bytes_per_site`: memory of a running site.
/// @throws Error(Configuration) when one site for each core does not fit.
SiteThreads site_threads(const RestFactor& factor, int cores, std::size_t sites, double memory,
                         double bytes_per_site, int most_per_core);

/// The same indices such that those of any beginning lie evenly among all: neighbours on a body
/// take alike long, and the first sites are to tell how long the others take. Multiples of the
/// golden section modulo 1 are as even as can be.
std::vector<std::size_t> spread_out(const std::vector<std::size_t>& indices);

/// Calls `work` once for every index below `count`, concurrently. After the first exception no
/// further index is started; it is rethrown once the running ones are done.
void parallel_for_sites(const RestFactor& factor, const SiteThreads& size, std::size_t count,
                        const std::function<void(SolvePool::Member&, std::size_t)>& work);

}  // namespace palpate::fem
