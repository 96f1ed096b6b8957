// SPDX-License-Identifier: AGPL-3.0-or-later
// Fast enough for the thread sanitizer.
#include "fem/campaign/parallel_sites.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include "fem/factor/memory.hpp"
#include "format/error.hpp"
#include "tests/unit/fem/factor/assembled_block.hpp"

namespace palpate::fem {
namespace {

class ParallelSites : public testing::Test {
 protected:
  Assembled block;
  RestFactor factor{block.model.pattern(), nested_dissection(block.model.pattern()), block.K,
                    "block"};
};

TEST_F(ParallelSites, ServesEachIndexOnceAndSolvesForEach) {
  const Eigen::VectorXd expected = block.dense.ldlt().solve(block.b);
  for (const SiteThreads& size :
       {SiteThreads{1, 1}, SiteThreads{2, 6}, SiteThreads{3, 48}, SiteThreads{4, 2}}) {
    constexpr std::size_t kCount = 61;
    std::vector<std::atomic<int>> calls(kCount);
    std::vector<double> error(kCount, 1);
    parallel_for_sites(factor, size, kCount, [&](SolvePool::Member& member, std::size_t i) {
      ++calls[i];
      Eigen::VectorXd x;
      const double scale = 1 + static_cast<double>(i);
      for (std::size_t turn = 0; turn <= i % 4; ++turn) member.solve(scale * block.b, x);
      error[i] = (x - scale * expected).norm() / (scale * expected.norm());
    });
    for (std::size_t i = 0; i < kCount; ++i) {
      EXPECT_EQ(calls[i], 1);
      EXPECT_LT(error[i], 1e-3);
    }
  }
}

TEST_F(ParallelSites, CallsNothingForNoSites) {
  parallel_for_sites(factor, {2, 4}, 0, [](SolvePool::Member&, std::size_t) { FAIL(); });
}

TEST_F(ParallelSites, StopsAfterAnExceptionAndRethrowsIt) {
  constexpr std::size_t kCount = 100000;
  std::atomic<std::size_t> calls{0};
  try {
    parallel_for_sites(factor, {2, 8}, kCount, [&](SolvePool::Member& member, std::size_t i) {
      ++calls;
      Eigen::VectorXd x;
      member.solve(block.b, x);
      if (i == 7) throw std::runtime_error("site 7");
    });
    FAIL() << "the exception is lost";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), std::string("site 7"));
  }
  EXPECT_GE(calls, 8u);
  EXPECT_LT(calls, kCount);
}

TEST_F(ParallelSites, HasAsManyThreadsAsThereAreSitesUpToABlockForEachCore) {
  const auto threads = [&](int cores, std::size_t sites) {
    const SiteThreads size = site_threads(factor, cores, sites, 0, 1e9, kBatch);
    EXPECT_EQ(size.cores, std::max(1, cores));
    return size.threads;
  };
  EXPECT_EQ(threads(2, 1000), 2 * kBatch);
  EXPECT_EQ(threads(2, 5), 5);
  EXPECT_EQ(threads(0, 5), 5);
  EXPECT_EQ(threads(4, 1), 1);
}

TEST_F(ParallelSites, OfASmallBodyAreFewForEachCoreWhereElementsAreRefinedMoreThanOnce) {
  IndentationSettings indentation;
  for (const int times : {0, 1}) {
    indentation.refine_under_tool = times;
    EXPECT_EQ(sites_for_each_core(indentation, 1000), kBatch);
  }
  for (const int times : {2, IndentationSettings::kByContact}) {
    indentation.refine_under_tool = times;
    EXPECT_LE(sites_for_each_core(indentation, 1000), kBatch / 2);
    EXPECT_EQ(sites_for_each_core(indentation, 100000), kBatch);
  }
  EXPECT_EQ(site_threads(factor, 3, 1000, 0, 1e9, 4).threads, 12);
}

/// A factor of a site's own takes half as much again as the shared one.
TEST_F(ParallelSites, HaveOwnFactorsInAQuarterOfTheMemory) {
  const double own = 1.5 * factor.bytes();
  EXPECT_EQ(places_for_own_factors(factor, 8, 4 * 3.5 * own), 3);
  EXPECT_EQ(places_for_own_factors(factor, 2, 4 * 3.5 * own), 2);  // one for each core
  EXPECT_EQ(places_for_own_factors(factor, 8, own), 1);            // one in any case
  EXPECT_EQ(places_for_own_factors(factor, 8, 0), 8);              // a machine has more
}

TEST_F(ParallelSites, HasFewerThreadsWhereMemoryIsShort) {
  constexpr double kSite = 1e12;                 // beside which the resident memory is negligible
  const double reserved = 3.5 * factor.bytes();  // one factor in double precision, one in single
  const auto threads = [&](double sites_per_core) {
    return site_threads(factor, 2, 1000, reserved + 2 * sites_per_core * kSite, kSite, kBatch)
        .threads;
  };
  EXPECT_EQ(threads(4.5), 2 * 4);
  EXPECT_EQ(threads(1.5), 2 * 1);
  EXPECT_EQ(threads(40.5), 2 * kBatch);
  EXPECT_THROW(threads(0.5), Error);
}

/// The largest gap of any beginning is at most three times the mean one.
TEST_F(ParallelSites, FirstOnesLieEvenlyAmongAll) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < 200; ++i) indices.push_back(5 * i + 7);
  const std::vector<std::size_t> spread = spread_out(indices);
  for (std::size_t count = 1; count <= spread.size(); ++count) {
    std::vector<std::size_t> first(spread.begin(),
                                   spread.begin() + static_cast<std::ptrdiff_t>(count));
    std::sort(first.begin(), first.end());
    EXPECT_EQ(std::adjacent_find(first.begin(), first.end()), first.end());
    std::size_t before = 2, largest = 0;
    for (const std::size_t index : first) {
      largest = std::max(largest, index - before);
      before = index;
    }
    largest = std::max(largest, std::size_t{1007} - before);
    EXPECT_LE(largest, 3 * 1005 / count) << count;
  }
  EXPECT_TRUE(spread_out({}).empty());
}

}  // namespace
}  // namespace palpate::fem
