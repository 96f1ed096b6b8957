// SPDX-License-Identifier: AGPL-3.0-or-later
// The displacement of the skin: kept by precompute, compressed by fit. Of a case with depths in
// [deformation].
#pragma once

#include <filesystem>

#include "app/pipeline/events.hpp"
#include "app/pipeline/workspace.hpp"
#include "fem/campaign/settings.hpp"
#include "format/body.hpp"
#include "format/curves.hpp"
#include "format/library.hpp"
#include "format/site_fields.hpp"

namespace palpate::app {

/// Has the campaign write the fields of each site to a file in the folder; known sites without such
/// a file are solved again.
void keep_fields_in(const std::filesystem::path& folder, int depths,
                    fem::CampaignSettings& settings);

/// The fields of the solution that these curves are of. @throws Error(Configuration) where they are
/// missing or of another solution.
SiteFields fields_of(const std::filesystem::path& folder, const SiteCurves& site);

/// Where the case asks for it, the campaign keeps its fields in space.fields().
void keep_fields(const Workspace& space, fem::CampaignSettings& settings);

/// Writes space.deformation() from the fields, or removes it where the case does not ask for it.
/// @throws Error(Configuration) where the fields of a site are missing or of another campaign.
void fit_deformation(const Workspace& space, const Body& body, const Curves& curves,
                     const Library& library, const EventSink& emit);

}  // namespace palpate::app
