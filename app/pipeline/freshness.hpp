// SPDX-License-Identifier: AGPL-3.0-or-later
// Is an artifact what a stage would make now? Decided from what its provenance says it was made
// from, never from file times.
#pragma once

#include <string>

#include "app/pipeline/settings.hpp"
#include "format/provenance.hpp"

namespace palpate::app {

/// The step to append to the provenance of what a stage has made.
ProvenanceStep make_stage_step(const Workspace& space, Stage stage,
                               std::vector<std::pair<std::string, std::string>> facts);

/// Empty when the last step of this stage had the same version of palpate, the same settings and
/// the same input files as it would have now; otherwise why not, in a few words.
std::string stale_reason(const Workspace& space, Stage stage, const Provenance& provenance);

}  // namespace palpate::app
