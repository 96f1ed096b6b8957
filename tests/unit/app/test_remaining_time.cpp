// SPDX-License-Identifier: AGPL-3.0-or-later
// Campaigns whose end is known: sites of given durations on a number of places.
#include "app/remaining_time.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace palpate::app {
namespace {

constexpr double kSetUp = 40;  // s, before the first site starts

struct Estimate {
  std::int64_t done = 0;
  double left = 0, truth = 0;  ///< s
};

/// Plays a campaign and notes the estimate after each site.
std::vector<Estimate> played(const std::vector<double>& durations, std::size_t places) {
  const auto total = static_cast<std::int64_t>(durations.size());
  RemainingTime time;
  time.begin(kSetUp);
  std::vector<double> ends;  // of the running sites
  std::size_t next = 0;
  std::vector<std::pair<double, Estimate>> seen;
  for (; next < std::min(places, durations.size()); ++next)
    ends.push_back(kSetUp + durations[next]);
  double now = kSetUp;
  for (std::int64_t done = 1; !ends.empty(); ++done) {
    const auto first = std::min_element(ends.begin(), ends.end());
    now = *first;
    ends.erase(first);
    time.update(now, done, static_cast<std::int64_t>(ends.size()), total);
    seen.push_back({now, {done, time.left(now).value(), 0}});
    if (next < durations.size()) ends.push_back(now + durations[next++]);
  }
  std::vector<Estimate> estimates;
  for (auto& [at, estimate] : seen) {
    estimate.truth = now - at;
    estimates.push_back(estimate);
  }
  return estimates;
}

std::vector<double> scattered(std::size_t count, double spread) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> factor(1 - spread, 1 + spread);
  std::vector<double> durations;
  for (std::size_t i = 0; i < count; ++i) durations.push_back(12 * factor(engine));
  return durations;
}

/// Right within 30 % from a tenth of the sites on, however many run side by side.
TEST(RemainingTime, IsRightWithinThirtyPercentAfterATenthOfTheSites) {
  for (const std::size_t places : {1U, 2U, 8U, 32U}) {
    const auto estimates = played(scattered(320, 0.4), places);
    for (const Estimate& e : estimates) {
      if (e.done < 32 || e.truth < 24) continue;  // the end of the last sites is their own
      EXPECT_NEAR(e.left / e.truth, 1, 0.3) << places << " places, " << e.done << " done";
    }
  }
}

/// After the first site of a batch the others of the batch are about to finish, too.
TEST(RemainingTime, IsRightAfterTheFirstSiteOfEqualOnes) {
  const auto estimates = played(std::vector<double>(96, 10), 32);
  EXPECT_NEAR(estimates.front().left, 20, 1e-9);
  EXPECT_NEAR(estimates.front().truth, 20, 1e-9);
}

/// The first sites are three times as expensive: the estimate follows the later ones.
TEST(RemainingTime, FollowsLaterSitesThatAreCheaper) {
  std::vector<double> durations(200, 10);
  std::fill(durations.begin(), durations.begin() + 10, 30.0);
  for (const Estimate& e : played(durations, 2))
    if (e.done >= 20 && e.truth > 20) {
      EXPECT_NEAR(e.left / e.truth, 1, 0.3) << e.done;
    }
}

TEST(RemainingTime, IsUnknownBeforeTheFirstSite) {
  RemainingTime time;
  time.begin(0);
  EXPECT_FALSE(time.left(5));
  time.update(5, 0, 4, 100);
  EXPECT_FALSE(time.left(6));
}

}  // namespace
}  // namespace palpate::app
