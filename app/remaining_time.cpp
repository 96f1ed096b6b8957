// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/remaining_time.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>

namespace palpate::app {
namespace {

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

void RemainingTime::begin(double now) {
  *this = {};
  began_ = now;
}

void RemainingTime::update(double now, std::int64_t done, std::int64_t running,
                           std::int64_t total) {
  total_ = total;
  // Before the first finish every site that runs or has just finished started at the beginning.
  if (durations_.empty())
    starts_.assign(static_cast<std::size_t>(std::max<std::int64_t>(running + done - done_, 0)),
                   began_);
  for (; done_ < done; ++done_) {
    durations_.push_back(now - (starts_.empty() ? began_ : starts_.front()));
    if (!starts_.empty()) starts_.pop_front();
    // Its place is taken at once.
    const auto unstarted = total_ - done_ - 1 - static_cast<std::int64_t>(starts_.size());
    if (unstarted > 0) starts_.push_back(now);
  }
}

/// Later sites tell more of those to come, so the first half of the finished ones does not count.
/// A site that has run longer than the mean counts with its age: the quick ones finish first.
double RemainingTime::mean_duration(double now) const {
  std::vector<double> recent(
      durations_.begin() + static_cast<std::ptrdiff_t>(durations_.size() / 2), durations_.end());
  const double mean = sum(recent) / static_cast<double>(recent.size());
  for (const double start : starts_)
    if (now - start > mean) recent.push_back(now - start);
  return sum(recent) / static_cast<double>(recent.size());
}

std::optional<double> RemainingTime::left(double now) const {
  if (durations_.empty()) return {};
  const double mean = mean_duration(now);
  // When each place becomes free; the sites that have not started take the first that is.
  std::priority_queue<double, std::vector<double>, std::greater<>> free;
  double last = 0;
  for (const double start : starts_) {
    free.push(std::max(0.0, mean - (now - start)));
    last = std::max(last, std::max(0.0, mean - (now - start)));
  }
  const auto unstarted = total_ - done_ - static_cast<std::int64_t>(starts_.size());
  for (std::int64_t i = 0; i < unstarted && !free.empty(); ++i) {
    const double end = free.top() + mean;
    free.pop();
    free.push(end);
    last = std::max(last, end);
  }
  return last;
}

}  // namespace palpate::app
