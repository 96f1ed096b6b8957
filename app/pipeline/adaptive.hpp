// SPDX-License-Identifier: AGPL-3.0-or-later
// Adaptive sampling: sites are added until the forces at hold-out points are within the tolerance.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "app/pipeline/events.hpp"
#include "app/pipeline/workspace.hpp"
#include "fem/campaign/campaign.hpp"
#include "format/body.hpp"

namespace palpate::app {

enum class SamplingEnd { ToleranceMet, NoLongerHelps, AllSites, MostSites };

/// Message: why sampling ended, and what may reduce a remaining error.
std::string words(SamplingEnd end);

struct AdaptiveCampaign {
  Curves curves;  ///< of the computed sites
  fem::CampaignReport report;
  std::vector<std::pair<std::string, std::string>> facts;  ///< for the provenance
  SamplingEnd end = SamplingEnd::AllSites;
};

/// Computes sites `[sampling] initial_spacing` apart, then adds in each round the sites of the
/// largest expected interpolation error (fitting::next_sites), at most half of the present number.
/// After each round the library of the case is rendered at random hold-out points of the surface
/// and compared with direct solutions there. Sampling ends when the 95th-percentile error along the
/// press is within the tolerance, when doubling the sites has reduced it by less than a tenth (the
/// rest is then not an error of interpolation), or when no site is left.
/// Deterministic. `hold-out.journal` contains the direct solutions until the curves are written.
/// @param settings  of the campaign; `known` sites are not computed again, and are not reported to
///   `finished` and `progress`
/// @param key  identifies the campaign
/// @throws as fem::run_campaign and fitting::fit.
AdaptiveCampaign sample_adaptively(const Workspace& space, const Body& body,
                                   fem::CampaignSettings settings, const std::string& key,
                                   fem::CampaignCache& cache,
                                   const std::function<void(const SamplingRound&)>& tell);

/// Removes the journal of the hold-out points, once the curves of the campaign are written.
void remove_hold_out(const Workspace& space);

}  // namespace palpate::app
