// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/remaining_time.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>

namespace palpate::app {
namespace {

/// A site that still runs after the mean is expected to take so many times what it took so far.
constexpr double kLate = 1.2;
/// All sites over the finished ones that say something of the others that run beside them.
constexpr std::int64_t kFirst = 10;

/// s of one second of service of each of n sites.
double seconds(std::size_t n) {
  return std::sqrt(static_cast<double>(std::max<std::size_t>(n, 1)));
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

void RemainingTime::begin(double now) {
  *this = {};
  last_ = now;
}

double RemainingTime::served(double now) const {
  return served_ + (now - last_) / seconds(starts_.size());
}

void RemainingTime::update(double now, std::int64_t done, std::int64_t running,
                           std::int64_t total) {
  total_ = total;
  // Before the first finish every site that runs or has just finished started at the beginning.
  if (services_.empty())
    starts_.assign(static_cast<std::size_t>(std::max<std::int64_t>(running + done - done_, 0)), 0);
  served_ = served(now);
  last_ = now;
  for (; done_ < done; ++done_) {
    services_.push_back(served_ - (starts_.empty() ? 0 : starts_.front()));
    if (!starts_.empty()) starts_.pop_front();
    // Its place is taken at once.
    const auto unstarted = total_ - done_ - 1 - static_cast<std::int64_t>(starts_.size());
    if (unstarted > 0) starts_.push_back(served_);
  }
}

/// Later sites tell more of those to come, so the first half of the finished ones does not count.
/// A site that has been served more than the mean counts with more than that: the quick ones finish
/// first.
double RemainingTime::mean_service(double served) const {
  std::vector<double> recent(services_.begin() + static_cast<std::ptrdiff_t>(services_.size() / 2),
                             services_.end());
  const double mean = sum(recent) / static_cast<double>(recent.size());
  for (const double start : starts_)
    if (served - start > mean) recent.push_back(kLate * (served - start));
  return sum(recent) / static_cast<double>(recent.size());
}

/// running: service that each site still needs. Each that ends makes room for one of the unstarted.
double RemainingTime::time_of(std::vector<double> running, std::int64_t unstarted,
                              double mean) const {
  if (running.empty()) return 0;
  // A whole round of all places leaves them as they were.
  const auto places = static_cast<std::int64_t>(running.size());
  const std::int64_t rounds = unstarted / places;
  double time = static_cast<double>(rounds) * mean * seconds(running.size());
  unstarted %= places;
  std::priority_queue<double, std::vector<double>, std::greater<>> ends(std::greater<>{},
                                                                        std::move(running));
  for (double at = 0; !ends.empty();) {
    const double end = ends.top();
    time += (end - at) * seconds(ends.size());
    at = end;
    ends.pop();
    if (unstarted-- > 0) ends.push(at + mean);
  }
  return time;
}

double RemainingTime::campaign(std::int64_t sites, std::int64_t places) const {
  if (services_.empty()) return 0;
  const double mean = sum(services_) / static_cast<double>(services_.size());
  const std::int64_t first = std::min(sites, places);
  return time_of(
      std::vector<double>(static_cast<std::size_t>(std::max<std::int64_t>(first, 0)), mean),
      sites - first, mean);
}

std::optional<double> RemainingTime::left(double now) const {
  if (services_.empty()) return {};
  const auto unstarted =
      std::max<std::int64_t>(total_ - done_ - static_cast<std::int64_t>(starts_.size()), 0);
  // Where all the others run already, the first ones that finish are the quick ones.
  if (unstarted == 0 && kFirst * done_ < total_) return {};
  const double here = served(now);
  const double mean = mean_service(here);
  std::vector<double> running;
  for (const double start : starts_) {
    const double age = here - start;
    running.push_back(age > mean ? (kLate - 1) * age : mean - age);
  }
  return time_of(std::move(running), unstarted, mean);
}

}  // namespace palpate::app
