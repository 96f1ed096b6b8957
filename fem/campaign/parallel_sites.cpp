// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/parallel_sites.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <deque>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "fem/factor/memory.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

SiteThreads site_threads(const RestFactor& factor, int cores, std::size_t sites, double memory,
                         double bytes_per_site) {
  SiteThreads size;
  size.cores = std::max(1, cores);
  const std::size_t sites_per_core = (sites + to_index(size.cores) - 1) / to_index(size.cores);
  const double double_precision_factor = 2 * factor.bytes();
  size.threads_per_core = fitting_times(
      memory, size.cores * bytes_per_site,
      static_cast<int>(std::min<std::size_t>(kBatch, sites_per_core)),
      "a site on each of " + std::to_string(size.cores) +
          " cores (memory is reserved for the factor that one site may need of its own)",
      double_precision_factor);
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
                        const std::function<void(SolveBatch::Member&, std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto serve = [&](SolveBatch& batch) {
    use_one_thread_per_site();
    SolveBatch::Member member(batch);
    try {
      for (std::size_t i = next++; i < count; i = next++) work(member, i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  std::deque<SolveBatch> batches;
  std::vector<std::thread> threads;
  for (int core = 0; core < size.cores; ++core)
    batches.emplace_back(factor, size.threads_per_core, &batches);
  for (SolveBatch& batch : batches)
    for (int i = 0; i < size.threads_per_core; ++i)
      threads.emplace_back([&serve, &batch] { serve(batch); });
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace palpate::fem
