// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <vector>

#include "fem/campaign/settings.hpp"
#include "fem/laws/law.hpp"
#include "format/body.hpp"

namespace palpate::fem {

/// The law of each region of the body, in its order.
/// @throws Error(Configuration) for a region without a law, a law without a region, a region named
/// twice, or constants out of range.
std::vector<Law> laws_of_regions(const Body& body, const std::vector<RegionMaterial>& materials);

/// The relaxation of each region of the body, in its order, over one list of times.
/// @throws Error(Configuration) as check_relaxation, and for a law without an isochoric part.
RegionRelaxation relaxation_of_regions(const Body& body,
                                       const std::vector<RegionMaterial>& materials);

/// The gravity of the settings with the density of each region of the body, in its order.
Gravity gravity_on(const Body& body, const CampaignSettings& settings);

/// The law of a region; fibres that depend on the body as samples of it.
/// @throws Error(Configuration) as fibres_of_potential, and where the file of the fibres was not
/// read.
LawConstants placed_on(const Body& body, std::int32_t region, const LawConstants& law);

}  // namespace palpate::fem
