// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/estimate.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "app/pipeline/campaign_sites.hpp"
#include "app/pipeline/settings.hpp"
#include "app/pipeline/stage_input.hpp"
#include "app/pipeline/trial_sites.hpp"
#include "fitting/response/fit.hpp"
#include "format/body.hpp"
#include "format/library.hpp"
#include "format/provenance.hpp"
#include "mesher/mesher.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

/// Certificate and provenance of a finished library, as far as their size matters.
void add_what_others_add(const Workspace& space,
                         const std::vector<std::pair<std::string, std::string>>& facts,
                         Library& library) {
  library.certificate.triangles.resize(library.triangles.size());
  for (const std::string& device : space.c.certify.devices)
    library.certificate.devices.push_back({device, 0, 0, 0, 0});
  for (const Stage stage : {Stage::Mesh, Stage::Precompute, Stage::Fit, Stage::Certify})
    library.provenance.steps.push_back(
        make_provenance_step(stage_name(stage), resolved_toml(space.c), {}, facts));
}

/// Bytes of library.h5 when `sites` have responses, from the library of the trial sites, which is
/// written beside no artifact; 0 when none of them has a response.
double library_bytes(const Workspace& space, const Body& body, const Trial& trial,
                     std::size_t sites) {
  const Curves& curves = trial.curves;
  const bool usable = std::any_of(curves.sites.begin(), curves.sites.end(), [&](const auto& site) {
    return fitting::usable(site, curves.depth);
  });
  if (!usable) return 0;
  Library library = fitting::fit(body, curves, fit_settings(space));
  add_what_others_add(space, trial.report.facts, library);
  const fs::path file =
      fs::temp_directory_path() / ("palpate-estimate-" + std::to_string(getpid()) + ".h5");
  write_library(file, library);
  const auto size = static_cast<double>(fs::file_size(file));
  fs::remove(file);
  double curve_bytes = 0, responses = 0;
  for (const NodeResponse& r : library.responses) {
    if (r.status == ResponseStatus::Hole) continue;
    ++responses;
    for (const ResponseCurve* curve : {&r.normal, &r.lateral, &r.coupling.curve})
      curve_bytes +=
          static_cast<double>(sizeof(float) * (curve->knot.size() + curve->slope.size()));
  }
  const double more = std::max(0.0, static_cast<double>(sites) - responses);
  return size + more * curve_bytes / responses;
}

void estimate(const Workspace& space, const Body& body, const EventSink& emit) {
  const std::vector<std::int32_t> all = sites_of_shard(body, space.shard);
  const Trial trial = press_trial_sites(space, body);
  const std::size_t tried = trial.curves.sites.size();
  Estimate event;
  event.sites = all.size();
  event.adaptive = is_adaptive(space);
  event.nodes = body.nodes.size();
  event.unknowns = trial.report.unknowns;
  event.trial_sites = tried;
  event.trial_seconds = trial.report.seconds;
  event.set_up_seconds = trial.report.set_up_seconds;
  event.seconds = campaign_seconds(space, trial, all.size());
  const double per_site =
      std::max(0.0, trial.bytes_between - trial.bytes_before) / static_cast<double>(tried);
  event.memory_bytes = trial.bytes_before +
                       per_site * static_cast<double>(concurrent_sites(space, trial, all.size()));
  if (space.memory > 0) event.memory_bytes = std::min(event.memory_bytes, space.memory);
  event.library_bytes = library_bytes(space, body, trial, all.size());
  event.threads = space.threads;
  emit(event);
}

}  // namespace

void estimate_build(const Workspace& space, const EventSink& emit) {
  campaign_settings(space);  // refuses measured bodies
  check_inputs(space, Stage::Certify);
  const Body body = mesher::mesh(mesh_settings(space));
  estimate(space, body, emit);
}

void estimate_precompute(const Workspace& space, const EventSink& emit) {
  estimate(space, read_input(space.body(), "mesh", read_body), emit);
}

}  // namespace palpate::app
