// SPDX-License-Identifier: AGPL-3.0-or-later
// Campaigns whose end is known: sites of given durations on a number of places.
#include "app/remaining_time.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "fem/campaign/parallel_sites.hpp"

namespace palpate::app {
namespace {

constexpr double kSetUp = 40;  // s, before the first site starts

struct NotedTime {
  std::int64_t done = 0;
  double left = 0, truth = 0;  ///< s
};

/// Part of the time of a site that the first increments take: the deeper ones take longer.
double time_until(double fraction) {
  return (fraction + 2 * fraction * fraction) / 3;
}

constexpr int kIncrements = 18;

/// s that one second of work takes while n sites run.
using Sharing = double (*)(std::size_t n);
double alone(std::size_t) {
  return 1;
}
/// Sites that share processors and block solves.
double sharing(std::size_t n) {
  return (20 + static_cast<double>(n)) / 21;
}

/// Plays a campaign and notes the estimate after each site.
class Player {
 public:
  /// `favoured`: how much faster every third site is served than the others.
  /// `last`: the increment after which a site ends; all where it is empty.
  Player(const std::vector<double>& durations, std::size_t places, Sharing slowness,
         const SiteSharing& sharing = {}, double favoured = 1, std::vector<int> last = {})
      : durations_(durations),
        last_(std::move(last)),
        slowness_(slowness),
        favoured_(favoured),
        time_(sharing) {
    last_.resize(durations.size(), kIncrements);
    time_.begin(kSetUp);
    while (sites_.size() < std::min(places, durations.size())) start_one();
    tell();
    while (!sites_.empty()) advance();
    for (auto& [at, estimate] : seen_) {
      estimate.truth = now_ - at;
      estimates.push_back(estimate);
    }
  }
  std::vector<NotedTime> estimates;

 private:
  struct Site {
    std::int32_t vertex;
    double work, worked;  ///< s
    int increments;
    double speed;
    /// s, until the end of the next increment
    double to_next() const {
      return (work * time_until((increments + 1.0) / kIncrements) - worked) / speed;
    }
  };

  void start_one() {
    if (next_ == durations_.size()) return;
    const double speed = next_ % 3 == 0 ? favoured_ : 1;
    sites_.push_back({static_cast<std::int32_t>(next_), durations_[next_], 0, 0, speed});
    ++next_;
  }

  void tell() {
    std::vector<SiteProgress> running;
    for (const Site& site : sites_)
      running.push_back(
          {site.vertex, static_cast<double>(site.increments) / kIncrements, site.worked});
    time_.update(now_, done_, static_cast<std::int64_t>(durations_.size()), running);
  }

  /// To the next end of an increment.
  void advance() {
    const auto first =
        std::min_element(sites_.begin(), sites_.end(),
                         [](const Site& a, const Site& b) { return a.to_next() < b.to_next(); });
    const double turn = first->to_next();
    double speeds = 0;
    for (const Site& site : sites_) speeds += site.speed;
    now_ += turn * slowness_(sites_.size()) * speeds / static_cast<double>(sites_.size());
    for (Site& site : sites_) site.worked += turn * site.speed;
    ++first->increments;
    tell();
    if (first->increments < last_[static_cast<std::size_t>(first->vertex)]) return;
    sites_.erase(first);
    ++done_;
    tell();
    seen_.push_back({now_, {done_, time_.left(now_).value(), 0}});
    start_one();
    tell();
  }

  std::vector<double> durations_;
  std::vector<int> last_;
  Sharing slowness_;
  double favoured_;
  RemainingTime time_;
  std::vector<Site> sites_;
  std::size_t next_ = 0;
  std::int64_t done_ = 0;
  double now_ = kSetUp;
  std::vector<std::pair<double, NotedTime>> seen_;
};

std::vector<NotedTime> played(const std::vector<double>& durations, std::size_t places,
                              Sharing slowness = alone) {
  return Player(durations, places, slowness).estimates;
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
    for (const NotedTime& e : estimates) {
      if (e.done < 32 || e.truth < 24) continue;  // the end of the last sites is their own
      EXPECT_NEAR(e.left / e.truth, 1, 0.3) << places << " places, " << e.done << " done";
    }
  }
}

/// After the first site of a batch the others of the batch are about to finish, too.
TEST(RemainingTime, IsRightAfterTheFirstSiteOfEqualOnes) {
  const auto estimates = played(std::vector<double>(96, 10), 32);
  EXPECT_NEAR(estimates.front().left, 20, 0.02);
  EXPECT_NEAR(estimates.front().truth, 20, 1e-9);
}

/// Thin parts: a fifth of the sites takes ten times as long, and the quick ones finish first.
TEST(RemainingTime, IsRightWhereSomeSitesTakeTenTimesAsLong) {
  for (const std::size_t places : {2U, 8U, 32U}) {
    std::vector<double> durations = scattered(320, 0.4);
    for (std::size_t i = 0; i < durations.size(); i += 5) durations[i] *= 10;
    const auto estimates = played(durations, places, sharing);
    for (const NotedTime& e : estimates) {
      if (e.done < 32 || e.truth < 0.1 * estimates.front().truth) continue;
      EXPECT_NEAR(e.left / e.truth, 1, 0.3) << places << " places, " << e.done << " done";
    }
  }
}

/// All run at once: what has not finished is slow, and its increments say how slow.
TEST(RemainingTime, KnowsSlowSitesBeforeTheyFinish) {
  std::vector<double> durations = scattered(32, 0.1);
  for (std::size_t i = 0; i < 16; ++i) durations[2 * i] *= 10;
  const auto estimates = played(durations, 32, sharing);
  EXPECT_NEAR(estimates[3].left / estimates[3].truth, 1, 0.3);
}

/// Two processors, on which sites take turns that are not alike: their processor times tell more
/// than how long they have run.
TEST(RemainingTime, GoesByTheProcessorTimeOfSitesThatAreServedUnevenly) {
  std::vector<double> durations = scattered(200, 0.4);
  for (std::size_t i = 0; i < durations.size(); i += 5) durations[i] *= 10;
  const Sharing two_processors = [](std::size_t n) {
    return std::max(1.0, static_cast<double>(n) / 2);
  };
  for (const std::size_t places : {32U, 200U}) {
    const Player player(durations, places, two_processors, {2, 1, true}, 4);
    for (const NotedTime& e : player.estimates) {
      if (e.done < 20 || e.truth < 0.1 * player.estimates.front().truth) continue;
      EXPECT_NEAR(e.left / e.truth, 1, 0.3) << places << " places, " << e.done << " done";
    }
  }
}

/// A site that ended early does not tell how long its last increments take.
TEST(RemainingTime, LearnsNothingOfIncrementsFromASiteThatEndedEarly) {
  RemainingTime time;
  time.begin(0);
  time.update(0, 0, 3, {{0, 0.0}, {1, 0.0}});
  time.update(2, 0, 3, {{0, 0.2}, {1, 0.2}});
  time.update(2, 1, 3, {{1, 0.2}});
  time.update(2, 1, 3, {{1, 0.2}, {2, 0.0}});
  ASSERT_TRUE(time.left(2));
  EXPECT_GT(*time.left(2), 6);
}

/// The times left of a campaign whose sites end after these increments.
void expect_right_times(const std::vector<int>& last) {
  for (const std::size_t places : {1U, 2U, 8U, 32U}) {
    const Player player(scattered(320, 0.4), places, alone, {}, 1, last);
    for (const NotedTime& e : player.estimates) {
      const auto last_groups = static_cast<std::int64_t>(2 * places);
      if (e.done < 48 || e.done + last_groups >= 320) continue;  // the end is its own
      if (e.truth < 0.1 * player.estimates.front().truth) continue;
      EXPECT_NEAR(e.left / e.truth, 1, 0.4) << places << " places, " << e.done << " done";
    }
  }
}

/// The tool is too deep for the body: each site ends in one of its first increments.
TEST(RemainingTime, IsRightWhereAllSitesEndEarly) {
  std::vector<int> last(320);
  for (std::size_t i = 0; i < last.size(); ++i) last[i] = 1 + static_cast<int>(i % 3);
  expect_right_times(last);
}

TEST(RemainingTime, IsRightWhereHalfOfTheSitesEndEarly) {
  std::vector<int> last(320, kIncrements);
  for (std::size_t i = 0; i < last.size(); i += 2) last[i] = 3;
  expect_right_times(last);
}

/// s of processor time of the 213 sites of the first case of the tongue of SOFA, by vertex. The
/// first tenth takes 1.6 times as long as the mean.
const std::vector<double> kTongue{
    2.98, 2.59, 2.80, 2.89, 2.25, 2.42, 2.84, 1.46, 2.57, 2.51, 2.54, 2.36, 2.40, 2.85, 3.37, 2.85,
    2.28, 2.38, 2.57, 2.62, 2.61, 3.06, 2.78, 2.61, 2.59, 1.74, 2.36, 2.25, 2.39, 2.22, 1.96, 1.74,
    2.84, 2.54, 1.89, 1.89, 2.49, 1.59, 2.33, 1.74, 2.08, 1.48, 1.73, 2.11, 2.54, 2.39, 1.80, 1.92,
    1.44, 2.32, 2.45, 1.29, 2.42, 1.58, 1.54, 1.18, 1.52, 1.45, 1.65, 2.28, 1.83, 1.54, 1.60, 2.08,
    2.53, 1.83, 1.57, 1.68, 1.24, 1.31, 2.35, 2.12, 1.58, 3.01, 0.89, 2.00, 1.80, 2.01, 1.02, 1.37,
    1.23, 1.52, 1.30, 1.82, 0.90, 1.74, 1.88, 1.48, 1.54, 1.12, 1.25, 1.37, 1.63, 1.32, 1.56, 1.17,
    1.13, 1.19, 1.41, 1.38, 1.64, 1.44, 1.01, 1.58, 1.50, 1.29, 1.71, 1.08, 0.82, 1.19, 1.06, 1.27,
    1.22, 1.12, 1.28, 1.25, 1.00, 1.28, 1.42, 1.16, 1.63, 1.27, 0.88, 1.40, 1.22, 1.11, 0.96, 1.47,
    1.05, 1.31, 1.09, 1.27, 1.40, 1.23, 1.05, 1.36, 1.62, 1.34, 1.40, 0.96, 1.40, 1.35, 1.28, 0.87,
    1.16, 1.21, 1.45, 1.45, 1.62, 1.27, 1.38, 1.33, 1.42, 1.32, 2.01, 1.26, 1.19, 1.63, 1.49, 1.46,
    1.08, 1.15, 1.52, 1.22, 1.44, 1.31, 1.50, 1.46, 1.79, 1.26, 1.33, 1.01, 1.16, 1.63, 1.08, 1.01,
    1.43, 2.01, 1.51, 1.73, 1.42, 1.16, 1.77, 1.25, 1.19, 1.07, 1.82, 1.32, 1.30, 1.29, 1.16, 1.60,
    1.33, 1.16, 1.31, 1.35, 1.45, 1.82, 1.36, 1.23, 1.39, 1.10, 1.22, 1.69, 1.23, 1.47, 1.90, 1.56,
    1.74, 1.52, 1.86, 2.04, 2.47};

/// s of processor time of the 104 sites of data/cases/liver.toml, by vertex.
const std::vector<double> kLiver{
    1.60, 1.40, 1.23, 1.41, 1.50, 1.85, 1.47, 1.29, 1.42, 1.46, 1.15, 1.42, 1.33, 1.27, 1.22,
    1.12, 0.89, 1.76, 1.42, 1.42, 2.12, 1.11, 0.83, 1.15, 0.87, 1.29, 1.24, 1.19, 1.23, 1.21,
    1.84, 0.90, 1.13, 1.19, 1.95, 1.93, 1.04, 0.92, 1.04, 0.91, 1.07, 0.93, 1.10, 1.87, 1.78,
    1.19, 1.14, 1.07, 1.55, 0.99, 1.26, 1.35, 1.28, 1.06, 1.20, 1.24, 1.84, 1.36, 0.91, 2.22,
    1.33, 1.52, 1.55, 1.38, 1.21, 1.46, 1.25, 0.96, 1.46, 1.97, 1.20, 0.84, 1.12, 1.21, 1.53,
    1.50, 1.36, 1.11, 1.29, 1.21, 1.14, 0.79, 1.34, 1.55, 1.79, 1.17, 1.57, 1.35, 0.95, 1.07,
    1.11, 1.38, 0.97, 1.03, 0.95, 1.29, 1.36, 1.18, 1.34, 1.70, 1.06, 1.04, 1.36, 1.09};

std::vector<double> in_order_of_campaign(const std::vector<double>& by_vertex) {
  std::vector<std::size_t> indices(by_vertex.size());
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  std::vector<double> durations;
  for (const std::size_t i : fem::spread_out(indices)) durations.push_back(by_vertex[i]);
  return durations;
}

TEST(RemainingTime, IsRightOnARecordedCampaign) {
  for (const std::size_t places : {1U, 2U, 8U, 32U}) {
    for (const Sharing slowness : {alone, sharing})
      for (const NotedTime& e : played(in_order_of_campaign(kTongue), places, slowness))
        if (e.done >= 21 && e.truth > 6) {
          EXPECT_NEAR(e.left / e.truth, 1, 0.3) << places << " places, " << e.done << " done";
        }
  }
}

/// When a tenth of the sites is done, the end of a real campaign is foretold within 30 %.
TEST(RemainingTime, OfRecordedCampaignsForetellsTheirEndAfterATenthOfTheSites) {
  for (const std::vector<double>& by_vertex : {kTongue, kLiver})
    for (const std::size_t places : {1U, 2U, 8U, 32U})
      for (const Sharing slowness : {alone, sharing}) {
        const auto estimates = played(in_order_of_campaign(by_vertex), places, slowness);
        const NotedTime& e = estimates.at(by_vertex.size() / 10);
        EXPECT_NEAR(e.left / e.truth, 1, 0.3)
            << places << " places, " << e.done << " of " << by_vertex.size() << " done";
      }
}

/// All sites take as long as their neighbours, and a quarter of the body takes ten times as long.
TEST(RemainingTime, IsRightOnARecordedCampaignWithAThinPart) {
  std::vector<double> by_vertex = kTongue;
  for (std::size_t i = 0; i < by_vertex.size() / 4; ++i) by_vertex[i] *= 10;
  for (const std::size_t places : {32U, 64U}) {  // 16 for each processor
    const auto estimates = played(in_order_of_campaign(by_vertex), places, sharing);
    for (const NotedTime& e : estimates)
      if (e.done >= 21 &&
          e.done + static_cast<std::int64_t>(places) < 213) {  // the last group is its own
        EXPECT_NEAR(e.left / e.truth, 1, 0.3) << places << " places, " << e.done << " done";
      }
  }
}

/// 8 of 104 are left for the last of four groups.
TEST(RemainingTime, IsRightForGroupsThatShareAProcessor) {
  const auto estimates = played(scattered(104, 0.1), 32, sharing);
  for (const NotedTime& e : estimates)
    if (e.done >= 10 && e.truth > 0.1 * estimates.front().truth) {
      EXPECT_NEAR(e.left / e.truth, 1, 0.3) << e.done << " done";
    }
}

/// 8 sites at a time for 10 s each; then 64 of them, 16 at a time.
TEST(RemainingTime, GivesTheTimeOfALargerCampaign) {
  RemainingTime trial;
  trial.begin(3);
  std::vector<SiteProgress> running;
  for (std::int32_t vertex = 0; vertex < 8; ++vertex) running.push_back({vertex, 0});
  trial.update(3, 0, 8, running);
  trial.update(13, 8, 8, {});
  EXPECT_NEAR(trial.campaign(8, 8), 10, 1e-9);
  EXPECT_NEAR(trial.campaign(64, 8), 80, 1e-9);
  // Twice as many at a time take sqrt(2) times as long for a group, and half as many groups.
  EXPECT_NEAR(trial.campaign(64, 16), 4 * 10 * std::sqrt(2), 1e-9);
  EXPECT_EQ(RemainingTime().campaign(64, 16), 0);
}

/// Where nothing is shared, as many at a time as there are processors are as fast as more.
TEST(RemainingTime, GainsLittleByMoreAtATimeWhereSitesShareNothing) {
  RemainingTime trial({2, 1});
  trial.begin(0);
  std::vector<SiteProgress> running;
  for (std::int32_t vertex = 0; vertex < 8; ++vertex) running.push_back({vertex, 0});
  trial.update(0, 0, 8, running);
  trial.update(10, 8, 8, {});
  EXPECT_NEAR(trial.campaign(64, 8), 80, 1e-9);
  EXPECT_NEAR(trial.campaign(64, 32), 80, 1e-9);
}

/// A trial that is ended early: a site that did not come as far as its first increment is slow.
TEST(RemainingTime, CountsSitesThatAreStuckInTheirFirstIncrement) {
  RemainingTime trial;
  trial.begin(0);
  trial.update(0, 0, 2, {{0, 0.0}, {1, 0.0}});
  trial.update(1, 0, 2, {{0, 0.1}, {1, 0.0}});
  trial.update(5, 0, 2, {{0, 0.5}, {1, 0.0}});
  // The first takes 10 s and the other at least 50 s.
  EXPECT_GT(trial.campaign(20, 2), 10 * 30);
}

TEST(RemainingTime, IsUnknownBeforeTheFirstSite) {
  RemainingTime time;
  time.begin(0);
  EXPECT_FALSE(time.left(5));
  time.update(5, 0, 100, {{3, 0.5}});
  EXPECT_FALSE(time.left(6));
}

}  // namespace
}  // namespace palpate::app
