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

/// How many of `sites` sites are pressed on a finer mesh too, by
/// CampaignSettings::mesh_error_sites: where there are few, every tenth, but two. 0 where elements
/// cannot be refined.
int count_on_finer_mesh(const CampaignSettings& settings, std::size_t sites);

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
                         CampaignReport& report, FactorCache* cache = nullptr);

}  // namespace palpate::fem
