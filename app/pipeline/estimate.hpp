// SPDX-License-Identifier: AGPL-3.0-or-later
// `--estimate`: what a campaign will take, from a few trial sites.
#pragma once

#include "app/pipeline/events.hpp"
#include "app/pipeline/workspace.hpp"

namespace palpate::app {

inline constexpr const char* kEstimateHelp =
    "Instead, press a few sites and say how many sites, minutes and bytes the campaign takes; "
    "nothing is written";

/// Meshes the body of the case in memory.
void estimate_build(const Workspace& space, const EventSink& emit);
/// For the body.h5 that is there. @throws Error(Configuration) where there is none.
void estimate_precompute(const Workspace& space, const EventSink& emit);

}  // namespace palpate::app
