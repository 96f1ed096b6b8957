// SPDX-License-Identifier: AGPL-3.0-or-later
// Sites that are pressed on a finer mesh as well: what they tell of the error that the mesh leaves
// in the forces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fem/campaign/campaign.hpp"
#include "fem/campaign/settings.hpp"
#include "format/body.hpp"
#include "format/curves.hpp"

namespace palpate::fem {

/// Up to `count` of the sites: the first, and then always the one farthest from those before
/// [Gonzalez 1985]. Ascending.
std::vector<std::int32_t> sites_far_apart(const Body& body, const std::vector<std::int32_t>& sites,
                                          int count);

/// Response vertices where the contact of the deepest press reaches a sharp edge of the body: the
/// mesh leaves a larger error there. The contact is taken as a circle, that of a sphere to sqrt(2 R
/// d) or its radius.
std::vector<bool> at_sharp_edges(const Body& body, const ToolDescription& tool, double depth);

/// The sites among `sites` that are pressed on a finer mesh too: of those at sharp edges and of the
/// others each CampaignSettings::mesh_error_sites, far apart; where there are few every tenth, but
/// three. None where elements cannot be refined. Ascending.
std::vector<std::int32_t> sites_on_finer_mesh(const Body& body, const CampaignSettings& settings,
                                              const std::vector<std::int32_t>& sites);

/// Presses those of the `chosen` sites that `curves` has with IndentationSettings::divide_once_more
/// along all their paths, and sets mesh_difference of their samples. With F the force along the
/// path, F' that of the finer mesh and h'/h the ratio of the sizes of the facets in contact,
///   mesh_difference = (F' - F)/(1 - (h'/h)^p),
/// Richardson's extrapolation of an error that decreases with h^p. p is 1, and 3/2 where elements
/// are divided by the contact; where the error decreases faster, this is more than the error. What
/// has no counterpart on the finer mesh stays unknown.
/// @throws as run_campaign, among others where obstacle_to_refinement names an obstacle.
void press_on_finer_mesh(const Body& body, const CampaignSettings& settings,
                         const std::vector<std::int32_t>& chosen, Curves& curves,
                         CampaignReport& report, CampaignCache* cache = nullptr);

}  // namespace palpate::fem
