// SPDX-License-Identifier: AGPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/console.hpp"
#include "app/pipeline/adaptive.hpp"
#include "app/pipeline/campaign_sites.hpp"
#include "app/pipeline/freshness.hpp"
#include "app/pipeline/settings.hpp"
#include "app/pipeline/stage_input.hpp"
#include "app/pipeline/stages.hpp"
#include "fem/factor/cholesky.hpp"
#include "format/body.hpp"
#include "format/sha256.hpp"
#include "format/site_journal.hpp"
#include "palpate_version.hpp"

namespace palpate::app {
namespace {

using Json = nlohmann::ordered_json;

/// All that decides the bits of the results.
std::string campaign_key(const Workspace& space, const std::string& body_sha256) {
  return sha256(fmt::format("{}\n{}\n{}\n{}\n{}\n{}/{}\n", body_sha256,
                            stage_case(space, Stage::Precompute), PALPATE_VERSION,
                            fem::blas_kernel(), fem::solver_versions(), space.shard.index,
                            space.shard.count));
}

/// What the user, or a program that watches, is told while the sites are computed.
class ProgressReporter {
 public:
  explicit ProgressReporter(Telling telling) : telling_(telling) {}

  /// A campaign begins: what decides its bits beside body and case, and what is known already.
  void start(const SiteJournal& journal, const std::filesystem::path& path) {
    if (telling_ == Telling::Json) {
      return event({{"event", "start"},
                    {"blas_kernel", fem::blas_kernel()},
                    {"kept_sites", journal.found().size()},
                    {"dropped_bytes", journal.dropped_bytes()},
                    {"moved_aside", journal.moved_aside()}});
    }
    say("  BLAS kernel: {}", fem::blas_kernel());
    if (journal.moved_aside())
      say("  the sites in {} are of another campaign: moved to {}.old", path.string(),
          path.filename().string());
    if (!journal.found().empty())
      say("  {} finished sites found in {}: they are not computed again", journal.found().size(),
          path.string());
    if (journal.dropped_bytes() > 0)
      say("  a site that was being written when the last run stopped ({} bytes) is computed again",
          journal.dropped_bytes());
  }

  /// A body of another case, or of this one before it was changed, is pressed as asked.
  void body(const std::filesystem::path& path, const std::string& stale_reason) {
    if (telling_ == Telling::Text && !stale_reason.empty())
      say("  WARNING: {} was not meshed by this case as it is now: {}; `palpate mesh` makes it "
          "again",
          path.string(), stale_reason);
  }

  /// Forces that are for looks must not be taken for more.
  void element(fem::Dilatation dilatation) {
    if (telling_ == Telling::Text && fem::is_linear(dilatation))
      say("  WARNING: element = \"tet4\" is for quick looks: its forces are too high by tens of "
          "percent, and the file says so; take tet10-pressure for a library to feel");
  }

  void site(const SiteCurves& site) {
    if (telling_ == Telling::Text) return;
    constexpr const char* kStatus[] = {"complete", "partial", "failed"};
    event({{"event", "site"},
           {"vertex", site.vertex},
           {"status", kStatus[static_cast<int>(site.status)]},
           {"reason", site.reason},
           {"cpu_seconds", site.cpu_seconds}});
  }

  void progress(const fem::CampaignProgress& p) {
    if (telling_ == Telling::Text)
      return display_.show(p.done, p.failed, p.running, p.total, p.known);
    event({{"event", "progress"},
           {"done", p.done},
           {"failed", p.failed},
           {"running", p.running},
           {"total", p.total}});
  }

  void round(const SamplingRound& r) {
    if (telling_ == Telling::Text)
      return say(
          "  round {}: {} of {} sites; at points held out 95 % of the forces are off by less than "
          "{:.1f} "
          "% along the press, {:.1f} % in all (median {:.1f} %)",
          r.number, r.sites, r.of_sites, 100 * r.along.p95, 100 * r.whole.p95,
          100 * r.whole.median);
    event({{"event", "round"},
           {"round", r.number},
           {"sites", r.sites},
           {"of_sites", r.of_sites},
           {"leave_one_out_error_p95", r.leave_one_out},
           {"hold_out_states", r.along.states},
           {"hold_out_points_failed", r.points_failed},
           {"error_along_press", error_of(r.along)},
           {"error_of_vector", error_of(r.whole)}});
  }

  void end(const std::filesystem::path& file, const SiteCounts& counts, double seconds,
           double cpu_seconds) {
    if (telling_ == Telling::Text) {
      return say(
          "precompute: {} sites complete, {} stopped early, {} failed, {} ({} on the processors) "
          "-> {}",
          counts.complete, counts.partial, counts.failed, duration_text(seconds),
          duration_text(cpu_seconds), file.string());
    }
    event({{"event", "end"},
           {"complete", counts.complete},
           {"partial", counts.partial},
           {"failed", counts.failed},
           {"seconds", seconds},
           {"cpu_seconds", cpu_seconds},
           {"file", file.string()}});
  }

  bool tells_text() const { return telling_ == Telling::Text; }

 private:
  static Json error_of(const fidelity::ErrorRow& row) {
    return {{"median", row.median}, {"p95", row.p95}, {"worst", row.worst}};
  }

  static void event(const Json& what) { print_line(what.dump()); }

  Telling telling_;
  ProgressDisplay display_{"precompute"};
};

/// A failed site is data, but one that a user must see.
void tell_failures(const Curves& curves) {
  constexpr std::size_t kLargestShown = 5;
  std::size_t shown = 0;
  for (const SiteCurves& site : curves.sites) {
    if (site.status == SiteStatus::Complete) continue;
    if (++shown > kLargestShown) continue;
    say("  site {} {}: {}", site.vertex,
        site.status == SiteStatus::Failed ? "failed" : "stopped early", site.reason);
  }
  if (shown > kLargestShown) say("  and {} more: see `palpate inspect`", shown - kLargestShown);
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

/// A part of a campaign that is done already: whoever starts all parts again, because some were
/// killed, does not compute the others twice. (A whole campaign is started again by those who mean
/// it.)
std::optional<SiteCounts> finished_part(const Workspace& space, ProgressReporter& reporter) {
  if (space.shard.count == 1 || !std::filesystem::exists(space.precomputed())) return {};
  const Curves curves = read_curves(space.precomputed());
  if (!stale_reason(space, Stage::Precompute, curves.provenance).empty()) return {};
  const SiteCounts counts = count_sites(curves);
  if (reporter.tells_text())
    say("precompute: {} is up to date", space.precomputed().string());
  else
    reporter.end(space.precomputed(), counts, 0, 0);
  return counts;
}

/// What one stage computes, however its sites are chosen.
struct Campaign {
  Curves curves;
  fem::CampaignReport report;
  std::vector<std::pair<std::string, std::string>> facts;
};

Campaign press_all(const Body& body, const fem::CampaignSettings& settings) {
  Campaign campaign;
  campaign.curves = fem::run_campaign(body, settings, campaign.report);
  return campaign;
}

Campaign press_by_need(const Workspace& space, const Body& body,
                       const fem::CampaignSettings& settings, const std::string& key,
                       ProgressReporter& reporter) {
  AdaptiveCampaign adaptive = sample_adaptively(
      space, body, settings, key, [&](const SamplingRound& round) { reporter.round(round); });
  if (reporter.tells_text())
    say("  {}{}",
        adaptive.end == SamplingEnd::ToleranceMet ? "" : "WARNING: ", words(adaptive.end));
  return {std::move(adaptive.curves), std::move(adaptive.report), std::move(adaptive.facts)};
}

/// Each round waits for all sites of the one before.
void require_whole(const Workspace& space) {
  if (space.shard.count == 1 || !is_adaptive(space)) return;
  throw Error(ErrorKind::Configuration, "--shard",
              "adaptive sampling chooses sites by the results of others and cannot be divided",
              "leave --shard out, or set sampling.method = \"spacing\"");
}

}  // namespace

SiteCounts run_precompute(const Workspace& space, Telling telling) {
  require_whole(space);
  const Body body = read_input(space.body(), "mesh", read_body);
  prepare_output(space.out);
  ProgressReporter reporter(telling);
  reporter.body(space.body(), stale_reason(space, Stage::Mesh, body.provenance));
  if (const auto counts = finished_part(space, reporter)) return *counts;
  const std::string body_sha256 = sha256_of_file(space.body());
  fem::CampaignSettings settings = campaign_settings(space);
  settings.sites = sites_of_shard(body, space.shard);

  const std::string key = campaign_key(space, body_sha256);
  SiteJournal journal(space.journal(), {key, static_cast<std::int64_t>(settings.sites.size())});
  reporter.start(journal, space.journal());
  reporter.element(settings.dilatation);
  settings.known = journal.found();
  settings.finished = [&](const SiteCurves& site) {
    journal.append(site);
    reporter.site(site);
  };
  settings.progress = [&](const fem::CampaignProgress& p) { reporter.progress(p); };

  auto [curves, report, facts] = is_adaptive(space)
                                     ? press_by_need(space, body, settings, key, reporter)
                                     : press_all(body, settings);
  curves.body_sha256 = body_sha256;
  const auto general = facts_of(space, report, settings.known.size());
  facts.insert(facts.begin(), general.begin(), general.end());
  append(curves.provenance, body.provenance, make_stage_step(space, Stage::Precompute, facts));
  write_curves(space.precomputed(), curves);
  journal.remove();
  remove_hold_out(space);
  const SiteCounts counts = count_sites(curves);
  reporter.end(space.precomputed(), counts, report.seconds, report.cpu_seconds);
  if (reporter.tells_text()) tell_failures(curves);
  return counts;
}

}  // namespace palpate::app
