// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace palpate::app {

/// Time that a campaign still takes, from when its sites finished. Sites run side by side; the time
/// before the first one starts, in which the stiffness matrix is factorized, counts for nothing.
/// Which site a finish belongs to is not told: the one that runs longest. That leaves the mean
/// duration as it is.
class RemainingTime {
 public:
  /// The first site starts. `now`: s, of any clock.
  void begin(double now);
  /// @param done  sites finished since the start
  /// @param running  sites that run now
  /// @param total  sites to do since the start
  void update(double now, std::int64_t done, std::int64_t running, std::int64_t total);
  /// s; none before the first site is finished.
  std::optional<double> left(double now) const;

 private:
  double mean_duration(double now) const;

  double began_ = 0;
  std::int64_t done_ = 0, total_ = 0;
  std::deque<double> starts_;      ///< of running sites, the oldest first
  std::vector<double> durations_;  ///< of finished sites
};

}  // namespace palpate::app
