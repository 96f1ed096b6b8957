// SPDX-License-Identifier: AGPL-3.0-or-later
// One function a stage: read the artifacts before, compute, append to the provenance, write.
#pragma once

#include <filesystem>
#include <vector>

#include "app/pipeline/settings.hpp"
#include "app/pipeline/workspace.hpp"
#include "format/curves.hpp"

namespace palpate::app {

/// Sites by status: what the exit code and the closing line depend on.
struct SiteCounts {
  std::size_t complete = 0, partial = 0, failed = 0;
  bool all_complete() const { return partial == 0 && failed == 0; }
};
SiteCounts count_sites(const Curves& curves);

void run_mesh(const Workspace& space);

/// How precompute tells what it does: a bar and lines for people, or a JSON object a line.
enum class Telling { Text, Json };
/// Every site computed is in the journal at once; a run that was interrupted is continued.
SiteCounts run_precompute(const Workspace& space, Telling telling = Telling::Text);
/// The parts that several machines computed -> curves.h5. `parts` empty: all in the folder.
SiteCounts run_merge(const Workspace& space, std::vector<std::filesystem::path> parts);

void run_fit(const Workspace& space);
void run_certify(const Workspace& space);

/// What may be kept at a rate.
struct KeepOptions {
  double rate = 0;                 ///< Hz
  std::filesystem::path device;    ///< profile; empty: those of the case
  std::filesystem::path softened;  ///< where a library goes that is softened until it is certified
};
/// Tells for each device the stiffest response that is certified at the rate and what the library
/// lacks for it; writes the softened library for a single device when it is asked for.
void run_keep(const Workspace& space, const KeepOptions& options);

/// Looks in the library, `tries` times in each triangle, for forces steeper than its certificate
/// says, and tells how near it came. @throws Error(Geometry) when it finds one.
void run_challenge(const Workspace& space, int tries);

/// The stages up to `last`, each only when its artifact is not up to date. @return the sites, none
/// when the curves were not asked for.
SiteCounts run_build(const Workspace& space, Stage last = Stage::Certify);

}  // namespace palpate::app
