// SPDX-License-Identifier: AGPL-3.0-or-later
// One function a stage: read the artifacts before it, compute, append to the provenance, write.
#pragma once

#include <filesystem>
#include <vector>

#include "app/pipeline/events.hpp"
#include "app/pipeline/settings.hpp"
#include "app/pipeline/workspace.hpp"
#include "format/curves.hpp"

namespace palpate::app {

SiteCounts count_sites(const Curves& curves);

/// Where the folder of the artifacts holds those of another case: two that share one would replace
/// each other's body, and lose its campaign. @throws Error(Configuration).
void refuse_body_of_another_case(const Workspace& space);

void run_mesh(const Workspace& space, const EventSink& emit);

/// Writes every computed site to the journal at once; continues an interrupted run.
SiteCounts run_precompute(const Workspace& space, const EventSink& emit);
/// Merges the parts of several machines into curves.h5. `parts` empty: all in the folder.
SiteCounts run_merge(const Workspace& space, std::vector<std::filesystem::path> parts,
                     const EventSink& emit);

void run_fit(const Workspace& space, const EventSink& emit);
void run_certify(const Workspace& space, const EventSink& emit);

/// The stiffest response that is certified at a sampling rate.
struct RateOptions {
  double rate = 0;                 ///< Hz
  std::filesystem::path device;    ///< profile; empty: those of the case
  std::filesystem::path softened;  ///< where to write the softened library; empty: nowhere
};
/// Reports StiffnessAtRate for each device. Writes a library softened until it is certified at the
/// rate, for a single device, when it is asked for.
void run_certify_at_rate(const Workspace& space, const RateOptions& options, const EventSink& emit);

/// Searches the library, `tries` times in each triangle, for forces steeper than its certificate
/// allows. @throws Error(Geometry) when it finds one.
void run_challenge(const Workspace& space, int tries, const EventSink& emit);

/// Runs the stages up to `last` whose artifacts are out of date. @return the counts of the sites;
/// none when `last` is Stage::Mesh.
SiteCounts run_build(const Workspace& space, Stage last, const EventSink& emit);

}  // namespace palpate::app
