// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/mesh_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/pipeline/campaign_sites.hpp"
#include "app/pipeline/settings.hpp"
#include "fem/campaign/campaign_context.hpp"
#include "fem/campaign/finer_mesh.hpp"
#include "fitting/response/mesh_error.hpp"
#include "format/error.hpp"

namespace palpate::app {
namespace {

/// The settings of the sites on the finer mesh, which tell their own progress.
fem::CampaignSettings with_progress_to(const EventSink& emit, fem::CampaignSettings settings) {
  const auto tell = [&emit](bool between_sites) {
    return [&emit, between_sites](const fem::CampaignProgress& p) {
      emit(FinerMeshProgress{
          {p.done, p.failed, p.running, p.total, p.known, p.sites, between_sites}});
    };
  };
  settings.progress = tell(false);
  settings.advanced = tell(true);
  return settings;
}

/// The sites of the whole campaign, also in a shard: all shards choose among the same.
std::vector<std::int32_t> candidates(const Workspace& space, const Body& body,
                                     const Curves& curves) {
  if (!is_adaptive(space)) return sites_of(body);
  std::vector<std::int32_t> sites;
  for (const SiteCurves& site : curves.sites) sites.push_back(site.vertex);
  return sites;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> estimate_mesh_error(
    const Workspace& space, const Body& body, const fem::CampaignSettings& settings, Curves& curves,
    fem::CampaignCache* cache, const EventSink& emit) {
  if (settings.mesh_error_sites == 0) return {};
  const std::string obstacle = fem::obstacle_to_refinement(settings);
  if (!obstacle.empty()) {
    emit(LogLine{"precompute",
                 "the error of the mesh stays unknown: elements cannot be refined "
                 "under the tool " +
                     obstacle});
    return {};
  }
  const auto chosen = fem::sites_on_finer_mesh(body, settings, candidates(space, body, curves));
  fem::CampaignReport report;
  try {
    fem::press_on_finer_mesh(body, with_progress_to(emit, settings), chosen, curves, report, cache);
  } catch (const Error& error) {
    emit(Warning{"precompute",
                 fmt::format("the error of the mesh stays unknown: {}", error.what())});
    return {};
  }
  fitting::bound_mesh_errors(curves, fem::at_sharp_edges(body, curves.tool, curves.depth));
  if (const std::string text = mesh_error_text(curves); !text.empty())
    emit(LogLine{"precompute", text});
  return {{"sites_on_finer_mesh", std::to_string(chosen.size())},
          {"cpu_seconds_on_finer_mesh", fmt::format("{:.3f}", report.cpu_seconds)}};
}

std::string mesh_error_text(const Curves& curves) {
  const fitting::MeshErrorSummary summary = fitting::mesh_error_summary(curves);
  if (std::isnan(summary.median_at_end)) return {};
  const double lateral = fitting::mesh_error_summary(curves, PathKind::Lateral).median_at_end;
  return fmt::format(
      "the mesh leaves an error of the normal force of at most {:.2g} % at the end of the path and "
      "{:.2g} % at the first increment{} (medians over the sites; {:.0f} % confidence)",
      100 * summary.median_at_end, 100 * summary.median_at_first,
      std::isnan(lateral) ? "" : fmt::format(", and {:.2g} % of the lateral force", 100 * lateral),
      100 * curves.mesh_error_confidence);
}

}  // namespace palpate::app
