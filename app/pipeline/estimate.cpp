// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/estimate.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "app/pipeline/campaign_sites.hpp"
#include "app/pipeline/settings.hpp"
#include "app/pipeline/stage_input.hpp"
#include "app/remaining_time.hpp"
#include "fem/campaign/campaign.hpp"
#include "fem/factor/rest_factor.hpp"
#include "fitting/response/fit.hpp"
#include "format/body.hpp"
#include "format/library.hpp"
#include "format/provenance.hpp"
#include "mesher/mesher.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kTrialsPerThread = 4;

/// Resident memory of this process, bytes; 0 where the system does not say.
double resident_bytes() {
  std::ifstream statistics("/proc/self/statm");
  double total = 0, resident = 0;
  statistics >> total >> resident;
  return statistics ? resident * static_cast<double>(sysconf(_SC_PAGESIZE)) : 0;
}

/// How the trial sites went.
struct Trial {
  Curves curves;
  fem::CampaignReport report;
  RemainingTime time;        ///< of the trial sites
  double bytes_before = 0;   ///< resident before the first site
  double bytes_between = 0;  ///< most that was resident when one finished
};

Trial press_some(const Workspace& space, const Body& body, std::vector<std::int32_t> sites) {
  Trial trial;
  const auto start = std::chrono::steady_clock::now();
  fem::CampaignSettings settings = campaign_settings(space);
  settings.sites = std::move(sites);
  const auto elapsed = [start] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  settings.advanced = [&](const fem::CampaignProgress& p) {
    trial.time.update(elapsed(), p.done, p.total, p.sites);
  };
  settings.progress = [&](const fem::CampaignProgress& p) {
    const double now = elapsed();
    const double bytes = resident_bytes();
    trial.bytes_between = std::max(trial.bytes_between, bytes);
    if (p.done > 0) return trial.time.update(now, p.done, p.total, p.sites);
    trial.bytes_before = bytes;
    trial.time.begin(now);
  };
  trial.curves = fem::run_campaign(body, settings, trial.report);
  return trial;
}

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
  const auto threads = static_cast<std::size_t>(space.threads);
  const Trial trial = press_some(space, body, spread(all, kTrialsPerThread * threads));
  const std::size_t tried = trial.curves.sites.size();
  const std::size_t per_thread = (all.size() + threads - 1) / threads;
  const std::size_t places = threads * std::min<std::size_t>(fem::kBatch, per_thread);
  Estimate event;
  event.sites = all.size();
  event.adaptive = is_adaptive(space);
  event.nodes = body.nodes.size();
  event.unknowns = trial.report.unknowns;
  event.trial_sites = tried;
  event.trial_seconds = trial.report.seconds;
  event.set_up_seconds = trial.report.set_up_seconds;
  event.seconds = event.set_up_seconds + trial.time.campaign(static_cast<std::int64_t>(all.size()),
                                                             static_cast<std::int64_t>(places));
  const double per_site =
      std::max(0.0, trial.bytes_between - trial.bytes_before) / static_cast<double>(tried);
  event.memory_bytes = trial.bytes_before + per_site * static_cast<double>(places);
  if (space.memory > 0) event.memory_bytes = std::min(event.memory_bytes, space.memory);
  event.library_bytes = library_bytes(space, body, trial, all.size());
  event.threads = space.threads;
  emit(event);
}

}  // namespace

std::vector<std::int32_t> spread(const std::vector<std::int32_t>& sites, std::size_t count) {
  if (count >= sites.size()) return sites;
  std::vector<std::int32_t> some;
  for (std::size_t i = 0; i < count; ++i)
    some.push_back(sites[(2 * i + 1) * sites.size() / (2 * count)]);
  return some;
}

void estimate_build(const Workspace& space, const EventSink& emit) {
  const Body body = mesher::mesh(mesh_settings(space));
  estimate(space, body, emit);
}

void estimate_precompute(const Workspace& space, const EventSink& emit) {
  estimate(space, read_input(space.body(), "mesh", read_body), emit);
}

}  // namespace palpate::app
