// SPDX-License-Identifier: AGPL-3.0-or-later
#include "runtime/latency_histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace palpate::runtime {
namespace {

TEST(LatencyHistogram, ItsQuantilesAreThoseOfTheSamplesWithinABucket) {
  std::mt19937 random(5);
  std::lognormal_distribution<double> any(9, 2.5);  // 8 us, over five decades
  std::vector<std::int64_t> samples(20000);
  LatencyHistogram histogram;
  for (auto& s : samples) {
    s = std::llround(any(random));
    histogram.add(s);
  }
  std::sort(samples.begin(), samples.end());
  for (const double share : {0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * 20000)) - 1;
    const auto exact = static_cast<double>(samples[rank]);
    EXPECT_GE(histogram.quantile(share), exact);
    EXPECT_LE(histogram.quantile(share), 1.126 * exact + 1);
  }
  EXPECT_EQ(histogram.largest(), samples.back());
  EXPECT_EQ(histogram.count(), 20000U);
}

TEST(LatencyHistogram, TakesAnyDuration) {
  LatencyHistogram histogram;
  EXPECT_EQ(histogram.quantile(0.5), 0);
  for (const std::int64_t ns : {std::int64_t{-5}, std::int64_t{0}, std::int64_t{1}, INT64_MAX}) {
    histogram.add(ns);
  }
  EXPECT_EQ(histogram.count(), 4U);
  EXPECT_LE(histogram.quantile(0.5), 2);
  EXPECT_GT(histogram.quantile(1), 1e12);
}

}  // namespace
}  // namespace palpate::runtime
