// SPDX-License-Identifier: AGPL-3.0-or-later
// Sampling by need: sites are added until forces elsewhere are met.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "app/pipeline/workspace.hpp"
#include "fem/campaign/campaign.hpp"
#include "fitting/fidelity/fidelity.hpp"
#include "format/body.hpp"

namespace palpate::app {

/// Where sampling stands after a round.
struct SamplingRound {
  int number = 0;
  std::size_t sites = 0, of_sites = 0;  ///< computed, and response points where the tool may press
  double leave_one_out = 0;  ///< 95th percentile of what neighbours miss at a computed site
  /// Relative error of the forces of normal presses at the points held out: along the press, which
  /// is what responses carry, and as vectors.
  fidelity::ErrorRow along, whole;
  std::size_t points_failed = 0;  ///< held out, but not solved to the end
};

enum class SamplingEnd { ToleranceMet, NoLongerHelps, AllSites, MostSites };

/// For people: why sampling ended, and what to do about an error that is left.
std::string words(SamplingEnd end);

struct AdaptiveCampaign {
  Curves curves;  ///< of the sites computed
  fem::CampaignReport report;
  std::vector<std::pair<std::string, std::string>> facts;  ///< how it went, for the provenance
  SamplingEnd end = SamplingEnd::AllSites;
};

/// Presses sites `[sampling] start_spacing` apart, then, round by round, those at which neighbours
/// are expected to miss (fitting::next_sites), at most half as many again as there are. After each
/// round the library that the case would make is pressed at random points of the surface through
/// the runtime, against direct solutions there that no fit has seen. It ends when 95 % of
/// these presses are met along their direction within the tolerance, when twice as many sites
/// have not lowered that error by a tenth (what is left is then not interpolation's), or when
/// nothing is left to add.
/// Deterministic. The direct solutions are kept in `held-out.journal` until the curves are written.
/// @param settings of the campaign; `known` sites are not computed again, `finished` and
///   `progress` are told of every other.
/// @param key identifies the campaign.
/// @throws as fem::run_campaign and fitting::fit.
AdaptiveCampaign sample_adaptively(const Workspace& space, const Body& body,
                                   fem::CampaignSettings settings, const std::string& key,
                                   const std::function<void(const SamplingRound&)>& tell);

/// The direct solutions at the points held out, of a campaign whose curves are written.
void forget_hold_out(const Workspace& space);

}  // namespace palpate::app
