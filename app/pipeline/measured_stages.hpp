// SPDX-License-Identifier: AGPL-3.0-or-later
// The first two stages of a case with [measured]: its records instead of a mesh and a campaign.
#pragma once

#include "app/pipeline/events.hpp"
#include "app/pipeline/workspace.hpp"

namespace palpate::app {

/// body.h5: the surface through the contact points of the records.
void run_measured_surface(const Workspace& space, const EventSink& emit);

/// curves.h5 and import.json: the records on that surface.
SiteCounts run_measured_curves(const Workspace& space, const EventSink& emit);

}  // namespace palpate::app
