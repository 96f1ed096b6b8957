// SPDX-License-Identifier: AGPL-3.0-or-later
// A few sites of a campaign, which tell how long all of them take.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "app/pipeline/workspace.hpp"
#include "app/remaining_time.hpp"
#include "fem/campaign/campaign.hpp"
#include "format/body.hpp"
#include "format/curves.hpp"

namespace palpate::app {

/// How the trial sites went.
struct Trial {
  Curves curves;  ///< empty where the patience ended first
  fem::CampaignReport report;
  RemainingTime time;        ///< of the trial sites
  std::size_t sites = 0;     ///< that were started or waited
  double on_finer_mesh = 0;  ///< sites that take as long as those that are pressed on a finer mesh
  double pressed = 0;        ///< s, from the first site to the end of the trial
  double bytes_before = 0;   ///< resident before the first site
  double bytes_between = 0;  ///< most that was resident when one finished
};

/// The sites from the thinnest part of the body to the thickest: what is thin bends, and takes
/// several times as long.
std::vector<std::int32_t> by_thickness(const Body& body, std::vector<std::int32_t> sites,
                                       double tool_radius);

/// `count` of the sites or all, spread over their order.
std::vector<std::int32_t> spread(const std::vector<std::int32_t>& sites, std::size_t count);

/// Presses six sites for each thread, spread over the thicknesses under those of the shard.
/// @param patience  s after which the sites that run are given up: their increments so far tell
///   how long they would have taken
Trial press_trial_sites(const Workspace& space, const Body& body,
                        double patience = std::numeric_limits<double>::infinity());

/// How many sites of `all` run concurrently.
std::size_t concurrent_sites(const Workspace& space, const Trial& trial, std::size_t all);

/// s that a campaign of so many sites takes: with what comes before the first, and with those that
/// are pressed on a finer mesh too.
double campaign_seconds(const Workspace& space, const Trial& trial, std::size_t sites);

}  // namespace palpate::app
