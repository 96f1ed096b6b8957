// SPDX-License-Identifier: AGPL-3.0-or-later
// Whether an artifact is up to date, by the inputs in its provenance and never by file times.
#pragma once

#include <string>

#include "app/pipeline/settings.hpp"
#include "format/provenance.hpp"

namespace palpate::app {

/// The provenance step of a stage.
ProvenanceStep make_stage_step(const Workspace& space, Stage stage,
                               std::vector<std::pair<std::string, std::string>> facts);

/// Why an artifact is out of date, in a few words; empty when the last step of the stage had the
/// version of palpate, the settings and the input files that it would have now.
std::string stale_reason(const Workspace& space, Stage stage, const Provenance& provenance);

/// Name of the case that a body was made from; "" where its provenance does not say.
std::string case_name(const Provenance& provenance);

}  // namespace palpate::app
