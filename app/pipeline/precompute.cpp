// SPDX-License-Identifier: AGPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "app/pipeline/adaptive.hpp"
#include "app/pipeline/campaign_sites.hpp"
#include "app/pipeline/fields.hpp"
#include "app/pipeline/freshness.hpp"
#include "app/pipeline/measured_stages.hpp"
#include "app/pipeline/mesh_error.hpp"
#include "app/pipeline/settings.hpp"
#include "app/pipeline/stage_input.hpp"
#include "app/pipeline/stages.hpp"
#include "fem/campaign/campaign_cache.hpp"
#include "fem/factor/cholesky.hpp"
#include "format/body.hpp"
#include "format/sha256.hpp"
#include "format/site_journal.hpp"
#include "palpate_version.hpp"

namespace palpate::app {
namespace {

/// Digest of everything that the bits of the results depend on.
std::string campaign_key(const Workspace& space, const std::string& body_sha256) {
  return sha256(fmt::format("{}\n{}\n{}\n{}\n{}\n{}/{}\n", body_sha256,
                            stage_case(space, Stage::Precompute), PALPATE_VERSION,
                            fem::blas_kernel(), fem::solver_versions(), space.shard.index,
                            space.shard.count));
}

/// Reasons to doubt the result that do not prevent the campaign.
void emit_warnings(const Workspace& space, const Body& body, const EventSink& emit) {
  const std::string stale = stale_reason(space, Stage::Mesh, body.provenance);
  if (!stale.empty())
    emit(Warning{"precompute", fmt::format("{} is out of date: {}; run `palpate mesh`",
                                           space.body().string(), stale)});
  if (fem::is_linear(space.c.campaign.dilatation))
    emit(Warning{"precompute",
                 "element = \"tet4\" gives forces that are tens of percent too high; use "
                 "tet10-pressure for a library to render"});
}

SiteFinished finished(const SiteCurves& site) {
  return {site.vertex, site.status, site.reason, site.cpu_seconds};
}

CampaignFinished campaign_finished(const Curves& curves, const fem::CampaignReport& report,
                                   const std::filesystem::path& file) {
  CampaignFinished event{count_sites(curves), report.seconds, report.cpu_seconds, file, {}};
  for (const SiteCurves& site : curves.sites)
    if (site.status != SiteStatus::Complete) event.incomplete.push_back(finished(site));
  return event;
}

/// Sites that ended early do not make a library useless: what they mean for it.
void warn_of_early_ends(const SiteCounts& counts, const EventSink& emit) {
  if (counts.all_complete()) return;
  const std::size_t early = counts.partial + counts.failed;
  emit(Warning{
      "precompute",
      fmt::format(
          "{} of {} sites ended early, {} of them without a response ({}); the report marks "
          "them on the body",
          early, counts.complete + early, counts.without_response,
          counts.usable() ? "the library is usable"
                          : "too many: look at the supports, the tool and the depth")});
}

std::vector<std::pair<std::string, std::string>> facts_of(const Workspace& space,
                                                          const fem::CampaignReport& report,
                                                          std::size_t known) {
  auto facts = report.facts;
  facts.emplace_back("threads", std::to_string(space.threads));
  facts.emplace_back("wall_seconds", fmt::format("{:.3f}", report.seconds));
  facts.emplace_back("cpu_seconds", fmt::format("{:.3f}", report.cpu_seconds));
  if (known > 0) facts.emplace_back("sites_of_interrupted_runs", std::to_string(known));
  if (space.shard.count > 1)
    facts.emplace_back("shard", fmt::format("{}/{}", space.shard.index, space.shard.count));
  return facts;
}

/// The counts of a shard that is up to date: when all shards are started again because some were
/// killed, the others end at once. A whole campaign is repeated on request.
std::optional<SiteCounts> finished_shard(const Workspace& space, const EventSink& emit) {
  if (space.shard.count == 1 || !std::filesystem::exists(space.precomputed())) return {};
  const Curves curves = read_curves(space.precomputed());
  if (!stale_reason(space, Stage::Precompute, curves.provenance).empty()) return {};
  emit(StageUpToDate{stage_name(Stage::Precompute), space.precomputed()});
  return count_sites(curves);
}

/// Result of the campaign, however its sites are chosen.
struct Campaign {
  Curves curves;
  fem::CampaignReport report;
  std::vector<std::pair<std::string, std::string>> facts;
};

Campaign press_all(const Body& body, const fem::CampaignSettings& settings,
                   fem::CampaignCache& cache) {
  Campaign campaign;
  campaign.curves = fem::run_campaign(body, settings, campaign.report, &cache);
  return campaign;
}

Campaign press_adaptively(const Workspace& space, const Body& body,
                          const fem::CampaignSettings& settings, const std::string& key,
                          fem::CampaignCache& cache, const EventSink& emit) {
  AdaptiveCampaign adaptive = sample_adaptively(space, body, settings, key, cache,
                                                [&](const SamplingRound& round) { emit(round); });
  emit(SamplingFinished{adaptive.end == SamplingEnd::ToleranceMet, words(adaptive.end)});
  return {std::move(adaptive.curves), std::move(adaptive.report), std::move(adaptive.facts)};
}

/// A round of adaptive sampling needs all sites of the round before.
void refuse_adaptive_shard(const Workspace& space) {
  if (space.shard.count == 1 || !is_adaptive(space)) return;
  throw Error(ErrorKind::Configuration, "--shard",
              "adaptive sampling cannot be divided: it chooses sites by the results of others",
              "leave --shard out, or set sampling.method = \"vertices\"");
}

}  // namespace

SiteCounts run_precompute(const Workspace& space, const EventSink& emit) {
  refuse_adaptive_shard(space);
  if (is_measured(space)) return run_measured_curves(space, emit);
  const Body body = read_input(space.body(), "mesh", read_body);
  prepare_output(space.out);
  emit_warnings(space, body, emit);
  if (const auto counts = finished_shard(space, emit)) return *counts;
  const std::string body_sha256 = sha256_of_file(space.body());
  fem::CampaignSettings settings = campaign_settings(space);
  settings.sites = sites_of_shard(body, space.shard);

  const std::string key = campaign_key(space, body_sha256);
  SiteJournal journal(space.journal(), {key, static_cast<std::int64_t>(settings.sites.size())});
  emit(CampaignStarted{fem::blas_kernel(), journal.found().size(), journal.dropped_bytes(),
                       journal.moved_aside(), space.journal(), sharing_of(settings)});
  settings.known = journal.found();
  keep_fields(space, settings);
  settings.finished = [&](const SiteCurves& site) {
    journal.append(site);
    emit(finished(site));
  };
  settings.preloading = [&](const fem::PreloadProgress& p) {
    emit(PreloadStep{p.steps, p.carried, p.shapes});
  };
  settings.progress = [&](const fem::CampaignProgress& p) {
    emit(Progress{p.done, p.failed, p.running, p.total, p.known, p.sites, false});
  };
  settings.advanced = [&](const fem::CampaignProgress& p) {
    emit(Progress{p.done, p.failed, p.running, p.total, p.known, p.sites, true});
  };

  fem::CampaignCache cache;
  auto [curves, report, facts] = is_adaptive(space)
                                     ? press_adaptively(space, body, settings, key, cache, emit)
                                     : press_all(body, settings, cache);
  curves.body_sha256 = body_sha256;
  const auto general = facts_of(space, report, settings.known.size());
  facts.insert(facts.begin(), general.begin(), general.end());
  const auto of_mesh = estimate_mesh_error(space, body, settings, curves, &cache, emit);
  facts.insert(facts.end(), of_mesh.begin(), of_mesh.end());
  append(curves.provenance, body.provenance, make_stage_step(space, Stage::Precompute, facts));
  write_curves(space.precomputed(), curves);
  journal.remove();
  remove_hold_out(space);
  emit(campaign_finished(curves, report, space.precomputed()));
  warn_of_early_ends(count_sites(curves), emit);
  return count_sites(curves);
}

}  // namespace palpate::app
