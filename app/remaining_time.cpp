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

/// Part of its service from which on a site that runs counts more by itself than by the others.
constexpr double kTelling = 0.01;

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Service at a fraction of the increments, between the increments of a site.
double service_at(double fraction, const std::vector<std::pair<double, double>>& passed) {
  std::pair<double, double> before{0, 0};
  for (const auto& next : passed) {
    if (fraction <= next.first) {
      const double part = (fraction - before.first) / (next.first - before.first);
      return before.second + part * (next.second - before.second);
    }
    before = next;
  }
  return before.second;
}

/// How far the past of a site tells its future.
double weight(double part) {
  return part / (part + kTelling);
}

}  // namespace

void RemainingTime::begin(double now) {
  *this = RemainingTime(sharing_);
  last_ = now;
}

double RemainingTime::seconds(std::size_t n) const {
  return std::pow(std::max(1.0, static_cast<double>(n) / sharing_.processors), sharing_.exponent);
}

double RemainingTime::served(double now) const {
  return served_ + (now - last_) / seconds(running_.size());
}

double RemainingTime::age(const Running& site, double served) {
  return (site.passed.empty() ? 0 : site.passed.back().second) + served - site.since;
}

void RemainingTime::update(double now, std::int64_t done, std::int64_t total,
                           const std::vector<SiteProgress>& running) {
  served_ = served(now);
  last_ = now;
  done_ = done;
  total_ = total;
  places_ = std::max(places_, running.size());
  for (const SiteProgress& site : running) {
    Running& seen = running_.try_emplace(site.vertex, Running{served_, {}}).first->second;
    if (site.fraction <= (seen.passed.empty() ? 0 : seen.passed.back().first)) continue;
    seen.passed.emplace_back(site.fraction,
                             sharing_.by_processor ? site.processor_seconds : age(seen, served_));
    seen.since = served_;
    if (step_ == 0) step_ = site.fraction;
  }
  for (auto it = running_.begin(); it != running_.end();) {
    const bool runs = std::any_of(running.begin(), running.end(), [&](const SiteProgress& site) {
      return site.vertex == it->first;
    });
    if (!runs) finish(it->second, age(it->second, served_));
    it = runs ? std::next(it) : running_.erase(it);
  }
}

/// A site that ended early does not tell how service is spread over the increments.
void RemainingTime::finish(const Running& site, double service) {
  services_.push_back(service);
  if (service <= 0) return;
  const std::pair<double, double> last =
      site.passed.empty() ? std::pair(0.0, 0.0) : site.passed.back();
  if (last.first < 1) {
    early_ends_.push_back({last.first, last.second > 0 ? service / last.second : 1});
    return;
  }
  for (std::size_t i = 0; i <= kParts; ++i)
    parts_[i] += service_at(static_cast<double>(i) / kParts, site.passed);
}

/// Part of the service of a site that so many of its increments take. Deeper increments take
/// longer: as long as no site has finished the rate is taken to grow linearly, by a factor of
/// three.
double RemainingTime::part_of_service(double fraction) const {
  if (parts_[kParts] == 0) return 0.5 * (fraction + fraction * fraction);
  const double place = fraction * kParts;
  const auto i = std::min(static_cast<std::size_t>(place), kParts - 1);
  const double within = place - static_cast<double>(i);
  return ((1 - within) * parts_[i] + within * parts_[i + 1]) / parts_[kParts];
}

/// Part of the service of a whole site that one takes which has come to this fraction, in the mean:
/// some end early. One more whole site than was seen is reckoned with.
double RemainingTime::expected_part(double fraction) const {
  const double whole = static_cast<double>(services_.size() - early_ends_.size()) + 1;
  double parts = whole, sites = whole;
  for (const EarlyEnd& end : early_ends_) {
    if (end.fraction < fraction) continue;
    parts += std::min(1.0, end.excess * part_of_service(std::max(end.fraction, step_)));
    ++sites;
  }
  return parts / sites;
}

/// By the increments that are done, and not less than the age of the site over the part that its
/// next increment ends: 0 as long as nothing is known of increments.
double RemainingTime::foretold_service(const Running& site, double served) const {
  if (step_ == 0) return 0;
  const double next = site.passed.empty() ? step_ : site.passed.back().first + step_;
  const double so_far = age(site, served);
  double whole = so_far / part_of_service(std::min(1.0, next));
  if (site.passed.empty()) return std::max(so_far, expected_part(0) * whole);
  const auto& [fraction, service] = site.passed.back();
  whole = std::max(whole, service / part_of_service(fraction));
  return std::max(so_far, expected_part(fraction) * whole);
}

/// The services of finished sites, of those whose increments tell something, and of those that take
/// longer than the mean of these before they have told anything.
std::vector<double> RemainingTime::likely_services(double served) const {
  std::vector<double> services = services_, silent;
  for (const auto& [vertex, site] : running_) {
    const bool tells = !site.passed.empty() && part_of_service(site.passed.back().first) > kTelling;
    (tells ? services : silent).push_back(foretold_service(site, served));
  }
  const double mean = services.empty() ? 0 : mean_of(services);
  for (const double service : silent)
    if (service > mean) services.push_back(service);
  std::sort(services.begin(), services.end());
  return services;
}

/// What its increments so far foretell, and the mean as long as they tell little.
double RemainingTime::remaining_service(const Running& site, double served, double mean) const {
  const double so_far = age(site, served);
  const double part = site.passed.empty() ? 0 : part_of_service(site.passed.back().first);
  const double foretold = std::max(0.0, foretold_service(site, served) - so_far);
  const double by_mean = std::max({mean - so_far, so_far, part > 0 ? 0 : foretold});
  return weight(part) * foretold + (1 - weight(part)) * (1 - part) * by_mean;
}

/// running: service that each site still needs. Each that ends makes room for one of the unstarted,
/// whose services are those of `likely` in turn, so that a slow one may come last.
double RemainingTime::time_of(const std::vector<double>& running, std::int64_t unstarted,
                              const std::vector<double>& likely) const {
  constexpr double golden = 0.6180339887498949;
  std::priority_queue<double, std::vector<double>, std::greater<>> ends(std::greater<>{}, running);
  double time = 0, at = 0, turn = 0;
  while (!ends.empty()) {
    const double end = ends.top();
    time += (end - at) * seconds(ends.size());
    at = end;
    ends.pop();
    if (unstarted-- <= 0) continue;
    turn += golden;
    turn -= std::floor(turn);
    const auto place = static_cast<std::size_t>(turn * static_cast<double>(likely.size()));
    ends.push(at + likely[std::min(place, likely.size() - 1)]);
  }
  return time;
}

double RemainingTime::campaign(std::int64_t sites, std::int64_t places) const {
  const std::vector<double> likely = likely_services(served_);
  if (likely.empty()) return 0;
  const std::int64_t first = std::max<std::int64_t>(std::min(sites, places), 0);
  return time_of(std::vector<double>(static_cast<std::size_t>(first), mean_of(likely)),
                 sites - first, likely);
}

double RemainingTime::unevenness() const {
  const std::vector<double> likely = likely_services(served_);
  if (likely.empty()) return 1;
  const double median = likely[(likely.size() - 1) / 2];
  return median > 0 ? mean_of(likely) / median : 1;
}

std::optional<double> RemainingTime::left(double now) const {
  if (services_.empty()) return {};
  auto unstarted =
      std::max<std::int64_t>(total_ - done_ - static_cast<std::int64_t>(running_.size()), 0);
  const double here = served(now);
  const std::vector<double> likely = likely_services(here);
  const double mean = mean_of(likely);
  std::vector<double> running;
  for (const auto& [vertex, site] : running_)
    running.push_back(remaining_service(site, here, mean));
  for (; running.size() < places_ && unstarted > 0; --unstarted)
    running.push_back(mean);  // the place of a site that has just finished is taken at once
  return time_of(running, unstarted, likely);
}

}  // namespace palpate::app
