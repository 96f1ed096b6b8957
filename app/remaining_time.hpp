// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "format/site_progress.hpp"

namespace palpate::app {

/// How sites that run disturb each other: while n run, each is served at the rate
/// max(1, n / processors)^-exponent.
struct SiteSharing {
  double processors = 1, exponent = 0.5;
  /// Whether the service of an increment is the processor time of its site: not where block solves
  /// take it, which count for the site that happens to do them.
  bool by_processor = false;
};

/// Time that a campaign still takes, from what its sites took so far. The time before the first
/// site starts, in which the stiffness matrix is factorized, counts for nothing.
///
/// Sites that run share processors and block solves. A block solve takes little less for few sites
/// than for many: where it takes most of the time, each of n sites is served at the rate 1/sqrt(n),
/// between 1, of sites that do not disturb each other, and 1/n. Sites whose own work takes the
/// time, as on elements that are refined under the tool, share nothing but the processors. The
/// service of a site, the integral of its rate from its start to its end, thus depends little on
/// how many run, and a last group of few sites takes less time than a full one.
///
/// Sites on thin parts need ten times the service of others, and the quick ones finish first. A
/// site that runs therefore counts with the service that its increments so far foretell, as it was
/// spread over the increments of finished sites together: the quick ones tell little of that.
///
/// Sites may end early. One that runs does so as often as those did that had come as far as it, and
/// after the part of its service that these took.
class RemainingTime {
 public:
  /// By default for sites that share block solves.
  explicit RemainingTime(const SiteSharing& sharing = {}) : sharing_(sharing) {}

  /// The first site starts. `now`: s, of any clock.
  void begin(double now);
  /// To be called at each start, increment and end of a site.
  /// @param done  sites finished since the start
  /// @param total  sites to do since the start
  /// @param running  sites that run now
  void update(double now, std::int64_t done, std::int64_t total,
              const std::vector<SiteProgress>& running);
  /// s; none before the first site is finished.
  std::optional<double> left(double now) const;
  /// s, of a campaign of so many such sites, `places` of them at a time; 0 before the first
  /// increment.
  double campaign(std::int64_t sites, std::int64_t places) const;
  /// Mean over median of the services of sites: far above 1 where some take much longer than most.
  /// 1 before the first increment.
  double unevenness() const;

 private:
  struct Running {
    double since = 0;                               ///< as the integral, its last increment
    std::vector<std::pair<double, double>> passed;  ///< fraction of the increments, service
  };

  /// s of one second of service of each of n sites.
  double seconds(std::size_t n) const;
  double served(double now) const;
  /// Service since the start of the site.
  static double age(const Running& site, double served);
  void finish(const Running& site, double service);
  double part_of_service(double fraction) const;
  double expected_part(double fraction) const;
  double foretold_service(const Running& site, double served) const;
  std::vector<double> likely_services(double served) const;
  double remaining_service(const Running& site, double served, double mean) const;
  double time_of(const std::vector<double>& running, std::int64_t unstarted,
                 const std::vector<double>& likely) const;

  SiteSharing sharing_;
  double last_ = 0;    ///< s, of the last update
  double served_ = 0;  ///< s, integral of the rate until then
  std::int64_t done_ = 0, total_ = 0;
  std::size_t places_ = 0;                   ///< largest number of sites that ran
  double step_ = 0;                          ///< fraction of the increments that one is
  std::map<std::int32_t, Running> running_;  ///< by vertex
  std::vector<double> services_;             ///< s, of finished sites
  /// A site that ended early: the fraction of its increments, and its service over that until the
  /// last of these.
  struct EarlyEnd {
    double fraction = 0, excess = 1;
  };
  std::vector<EarlyEnd> early_ends_;
  /// Sum of the services of finished sites until i/kParts of their increments.
  static constexpr std::size_t kParts = 20;
  std::array<double, kParts + 1> parts_{};
};

}  // namespace palpate::app
