// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>

#include "app/pipeline/events.hpp"
#include "app/pipeline/workspace.hpp"
#include "fem/campaign/campaign.hpp"
#include "format/body.hpp"
#include "format/curves.hpp"

namespace palpate::app {

/// Presses some sites of the campaign on a finer mesh as well, and sets the error of the mesh of
/// all samples: `[solver] mesh_error_sites`. A shard presses those of them that it has. Where
/// elements cannot be refined the errors stay unknown, and a line of the log says why.
/// @return facts for the provenance.
std::vector<std::pair<std::string, std::string>> estimate_mesh_error(
    const Workspace& space, const Body& body, const fem::CampaignSettings& settings, Curves& curves,
    fem::CampaignCache* cache, const EventSink& emit);

/// One sentence on the error of the mesh; empty where it is unknown.
std::string mesh_error_text(const Curves& curves);

}  // namespace palpate::app
