// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/parallel_sites.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "fem/factor/memory.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

/// A factor of a site's own with its fronts, over the shared factor; one in double precision.
constexpr double kOwnFactor = 1.5, kOwnFactorInDouble = 2;

/// Sites on refined elements for each core: blocks that are less than half full then cost a
/// twentieth of the time, as long as the factor is small.
constexpr int kFewestSites = 6, kUnknownsForEachSite = 4000;

/// Share of the memory that the process may use.
constexpr double kShareOfOwnFactors = 0.25;

double bytes_of_own_factor(const RestFactor& factor) {
  return (factor.in_double_precision() ? 2 : 1) * kOwnFactor * factor.bytes();
}

}  // namespace

int places_for_own_factors(const RestFactor& factor, int cores, double memory) {
  const double room = kShareOfOwnFactors * (memory > 0 ? memory : machine_bytes());
  return static_cast<int>(
      std::clamp(std::floor(room / bytes_of_own_factor(factor)), 1.0, std::max(1.0, 1.0 * cores)));
}

int sites_for_each_core(const IndentationSettings& indentation, int unknowns) {
  const int times = indentation.refine_under_tool;
  if (times != IndentationSettings::kByContact && times <= 1) return kBatch;
  return std::clamp(unknowns / kUnknownsForEachSite, kFewestSites, kBatch);
}

SiteThreads site_threads(const RestFactor& factor, int cores, std::size_t sites, double memory,
                         double bytes_per_site, int most_per_core) {
  SiteThreads size;
  size.cores = std::max(1, cores);
  const std::size_t sites_per_core = (sites + to_index(size.cores) - 1) / to_index(size.cores);
  // One site at a time may factorize the body in double precision.
  const double own_factors =
      kOwnFactorInDouble * factor.bytes() +
      (places_for_own_factors(factor, size.cores, memory) - 1) * bytes_of_own_factor(factor);
  const int per_core = fitting_times(
      memory, size.cores * bytes_per_site,
      static_cast<int>(std::min(to_index(most_per_core), sites_per_core)),
      "a site on each of " + std::to_string(size.cores) +
          " cores (memory is reserved for the factors that sites may need of their own)",
      own_factors);
  size.threads = static_cast<int>(std::min(sites, to_index(per_core * size.cores)));
  return size;
}

std::vector<std::size_t> spread_out(const std::vector<std::size_t>& indices) {
  constexpr double golden = 0.6180339887498949;
  std::vector<std::pair<double, std::size_t>> turns;  // of a circle, and which of them
  for (std::size_t k = 0; k < indices.size(); ++k) {
    const double turn = golden * static_cast<double>(k);
    turns.emplace_back(turn - std::floor(turn), k);
  }
  std::sort(turns.begin(), turns.end());
  std::vector<std::size_t> spread(indices.size());
  for (std::size_t i = 0; i < turns.size(); ++i) spread[turns[i].second] = indices[i];
  return spread;
}

void parallel_for_sites(const RestFactor& factor, const SiteThreads& size, std::size_t count,
                        const std::function<void(SolvePool::Member&, std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  SolvePool pool(factor, size.cores);
  share_heaps(size.cores);
  const auto serve = [&] {
    use_one_thread_per_site();
    SolvePool::Member member(pool);
    try {
      for (std::size_t i = next++; i < count; i = next++) work(member, i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < size.threads; ++i) threads.emplace_back(serve);
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace palpate::fem
