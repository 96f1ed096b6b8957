// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace palpate::app {

/// Time that a campaign still takes, from when its sites finished. The time before the first site
/// starts, in which the stiffness matrix is factorized, counts for nothing.
///
/// Sites that run share processors and block solves. While n run, each is served at the rate
/// 1/sqrt(n): between 1, of sites that do not disturb each other, and 1/n, of sites that share
/// nothing but the processor; a block solve takes little less for few sites than for many. The
/// service of a site, the integral of dt / sqrt(n) from its start to its end, thus depends little
/// on how many run, and a last group of few sites takes less time than a full one. Which site a
/// finish belongs to is not told: the one that runs longest. That leaves the mean as it is.
class RemainingTime {
 public:
  /// The first site starts. `now`: s, of any clock.
  void begin(double now);
  /// @param done  sites finished since the start
  /// @param running  sites that run now
  /// @param total  sites to do since the start
  void update(double now, std::int64_t done, std::int64_t running, std::int64_t total);
  /// s; none before the first site is finished, nor where all others run already and less than a
  /// tenth is finished.
  std::optional<double> left(double now) const;
  /// s, of a campaign of so many such sites, `places` of them at a time; 0 before the first site is
  /// finished.
  double campaign(std::int64_t sites, std::int64_t places) const;

 private:
  double served(double now) const;
  double mean_service(double served) const;
  double time_of(std::vector<double> running, std::int64_t unstarted, double mean) const;

  double last_ = 0;    ///< s, of the last update
  double served_ = 0;  ///< s, integral of dt / sqrt(n) until then
  std::int64_t done_ = 0, total_ = 0;
  std::deque<double> starts_;     ///< of running sites, as the integral, the oldest first
  std::vector<double> services_;  ///< s, of finished sites
};

}  // namespace palpate::app
