// SPDX-License-Identifier: AGPL-3.0-or-later
// Campaigns whose end is known: sites of given durations on a number of places.
#include "app/remaining_time.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <utility>
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
/// The quickest of sites that all run at once says nothing of the slow ones.
TEST(RemainingTime, IsUnknownWhileFewOfTheSitesThatRunHaveFinished) {
  RemainingTime time;
  time.begin(0);
  time.update(60, 1, 31, 32);
  EXPECT_FALSE(time.left(60));
  time.update(70, 4, 28, 32);
  EXPECT_TRUE(time.left(70));
}

TEST(RemainingTime, FollowsLaterSitesThatAreCheaper) {
  std::vector<double> durations(200, 10);
  std::fill(durations.begin(), durations.begin() + 10, 30.0);
  for (const Estimate& e : played(durations, 2))
    if (e.done >= 20 && e.truth > 20) {
      EXPECT_NEAR(e.left / e.truth, 1, 0.3) << e.done;
    }
}

/// s from the first start to the finish of each of the 104 sites of data/cases/liver.toml, on two
/// processors, 16 sites on each at a time.
constexpr double kLiver[] = {
    120.7, 125.8, 126.5, 130.1, 130.8, 131.3, 131.4, 131.9, 132.6, 132.7, 133.2, 133.7, 134.5,
    135.5, 136.1, 136.6, 136.9, 137.0, 137.6, 138.0, 139.7, 141.1, 141.6, 142.2, 142.9, 143.3,
    145.0, 154.1, 154.8, 158.1, 159.4, 169.1, 250.9, 252.8, 253.5, 254.2, 257.0, 257.1, 258.4,
    259.2, 260.7, 261.3, 261.7, 262.7, 263.3, 266.3, 266.7, 267.4, 267.5, 268.2, 268.4, 269.4,
    275.4, 276.2, 278.9, 279.7, 282.8, 286.6, 298.9, 300.1, 304.7, 305.0, 324.8, 325.0, 386.1,
    388.3, 390.0, 391.6, 395.2, 397.8, 399.4, 400.8, 401.0, 401.9, 402.7, 403.0, 403.1, 403.5,
    404.1, 406.1, 406.9, 407.4, 407.6, 407.8, 407.9, 408.1, 408.4, 410.0, 411.4, 416.2, 420.7,
    424.1, 426.2, 427.8, 443.8, 447.6, 474.7, 476.5, 476.8, 476.8, 478.2, 481.1, 481.3, 483.8};

TEST(RemainingTime, IsRightOnARecordedCampaign) {
  constexpr std::int64_t total = std::size(kLiver), places = 32;
  RemainingTime time;
  time.begin(kSetUp);
  for (std::int64_t done = 1; done <= total; ++done) {
    const double at = kSetUp + kLiver[done - 1], truth = kSetUp + kLiver[total - 1] - at;
    time.update(at, done, std::min(places - 1, total - done), total);
    if (10 * done < total || truth < 48) continue;
    EXPECT_NEAR(time.left(at).value() / truth, 1, 0.3) << done << " done";
  }
}

/// Sites that share processors and block solves: while n run, each proceeds at the rate
/// 1 / (20 + n). 8 of 104 are left for the last of four groups.
TEST(RemainingTime, IsRightForGroupsThatShareAProcessor) {
  const std::vector<double> durations = scattered(104, 0.1);
  const auto total = static_cast<std::int64_t>(durations.size());
  std::vector<double> running(durations.begin(), durations.begin() + 32);  // work that is left
  std::size_t next = running.size();
  RemainingTime time;
  time.begin(kSetUp);
  double now = kSetUp;
  std::vector<std::pair<double, double>> estimates;
  for (std::int64_t done = 1; !running.empty(); ++done) {
    const auto first = std::min_element(running.begin(), running.end());
    const double work = *first;
    now += work * (20 + static_cast<double>(running.size()));
    running.erase(first);
    for (double& left : running) left -= work;
    time.update(now, done, static_cast<std::int64_t>(running.size()), total);
    if (10 * done >= total) estimates.emplace_back(now, time.left(now).value());
    if (next < durations.size()) running.push_back(durations[next++]);
  }
  for (const auto& [at, left] : estimates)
    if (now - at > 0.1 * (now - kSetUp)) {
      EXPECT_NEAR(left / (now - at), 1, 0.3) << at;
    }
}

/// 8 sites at a time for 10 s each; then 64 of them, 16 at a time.
TEST(RemainingTime, GivesTheTimeOfALargerCampaign) {
  RemainingTime trial;
  trial.begin(3);
  for (std::int64_t done = 1; done <= 8; ++done) trial.update(13, done, 8 - done, 8);
  EXPECT_NEAR(trial.campaign(8, 8), 10, 1e-9);
  EXPECT_NEAR(trial.campaign(64, 8), 80, 1e-9);
  // Twice as many at a time take sqrt(2) times as long for a group, and half as many groups.
  EXPECT_NEAR(trial.campaign(64, 16), 4 * 10 * std::sqrt(2), 1e-9);
  EXPECT_EQ(RemainingTime().campaign(64, 16), 0);
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
