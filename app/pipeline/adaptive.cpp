// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/adaptive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <system_error>

#include "app/pipeline/campaign_sites.hpp"
#include "app/pipeline/settings.hpp"
#include "fem/campaign/campaign_cache.hpp"
#include "fitting/fidelity/fidelity.hpp"
#include "fitting/fidelity/skin.hpp"
#include "fitting/measurement/nearest_rank.hpp"
#include "fitting/response/fit.hpp"
#include "fitting/response/interpolate.hpp"
#include "fitting/sampling/site_choice.hpp"
#include "format/sha256.hpp"
#include "format/site_journal.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

/// Differs from the seed of `palpate compare --fem`, so that sampling has not used its points.
constexpr std::uint32_t kSeed = 20051031;

constexpr std::size_t kMinAdded = 8;     // sites in a round
constexpr std::size_t kGrowth = 4;       // adds a quarter to a half of the present number
constexpr double kMinTarget = 1.0 / 64;  // of the tolerance

fs::path hold_out_journal(const Workspace& space) {
  return space.out / "hold-out.journal";
}

/// A file that is removed at the end of its scope, also after an error.
class TemporaryFile {
 public:
  explicit TemporaryFile(fs::path path) : path_(std::move(path)) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code none;
    fs::remove(path_, none);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Random points of the surface and the direct solutions there.
class HoldOut {
 public:
  HoldOut(const Workspace& space, const Body& body, const Library& library,
          fem::CampaignCache& cache, fem::CampaignSettings settings, const std::string& key)
      : space_(space) {
    points_ = fidelity::draw_points(library, space.c.sampling.hold_out_points, 0, kSeed);
    fidelity::find_skin(body, points_);
    settings.sites.clear();
    for (const fidelity::HoldOutPoint& p : points_)
      settings.points.push_back({p.position + p.skin * p.inward, p.inward});
    settings.indentation.lateral_depths.clear();  // lateral paths are not judged
    SiteJournal journal(hold_out_journal(space),
                        {sha256("hold-out\n" + key), static_cast<std::int64_t>(points_.size())});
    settings.known = journal.found();
    settings.finished = [&](const SiteCurves& site) { journal.append(site); };
    settings.progress = nullptr;
    settings.advanced = nullptr;
    settings.fields = nullptr;
    direct_ = fem::run_campaign(body, settings, report_, &cache);
  }

  const fem::CampaignReport& report() const { return report_; }

  void evaluate(const Library& library, const Curves& curves, SamplingRound& round) const {
    const TemporaryFile file(space_.out / ".library.hold-out.h5");
    write_library(file.path(), library);
    const fidelity::Fidelity result =
        fidelity::measure({library, fidelity::RenderedBody(file.path()), points_, direct_, curves},
                          {0.02, space_.c.certify.friction});
    round.points_failed = result.left_out.size();
    for (const fidelity::ErrorRow& row : result.rows) {
      if (row.what != fidelity::kNormalOffNode) continue;
      if (row.part == "normal") round.along = row;
      if (row.part == "total") round.whole = row;
    }
  }

 private:
  const Workspace& space_;
  std::vector<fidelity::HoldOutPoint> points_;
  Curves direct_;
  fem::CampaignReport report_;
};

/// Solved sites by vertex, from this run or an interrupted one. Some of the latter belong to later
/// rounds.
class KnownSites {
 public:
  explicit KnownSites(const std::vector<SiteCurves>& sites) { add(sites); }

  void add(const std::vector<SiteCurves>& sites) {
    for (const SiteCurves& site : sites) sites_.insert_or_assign(site.vertex, site);
  }

  std::vector<SiteCurves> among(const std::vector<std::int32_t>& vertices) const {
    std::vector<SiteCurves> chosen;
    for (const std::int32_t vertex : vertices) {
      const auto found = sites_.find(vertex);
      if (found != sites_.end()) chosen.push_back(found->second);
    }
    return chosen;
  }

 private:
  std::map<std::int32_t, SiteCurves> sites_;
};

double p95_of(const std::vector<fitting::LeaveOneOutError>& errors) {
  if (errors.empty()) return 0;
  std::vector<double> relative;
  for (const fitting::LeaveOneOutError& error : errors) relative.push_back(error.relative);
  std::sort(relative.begin(), relative.end());
  return relative[fitting::nearest_rank(relative.size(), 0.95)];
}

/// Sites to add, those of the largest expected error first. The target is lowered until there are
/// enough of them, since the hold-out points show that the present one is insufficient.
std::vector<std::int32_t> sites_to_add(const Workspace& space, const Body& body,
                                       const std::vector<std::int32_t>& computed,
                                       const Library& library) {
  const SamplingSection& sampling = space.c.sampling;
  const auto max_sites = static_cast<std::size_t>(sampling.max_sites);
  if (computed.size() >= max_sites) return {};
  const std::size_t fewest = std::max(kMinAdded, computed.size() / kGrowth);
  const std::size_t most = std::min(2 * fewest, max_sites - computed.size());
  std::vector<std::int32_t> sites;
  for (double part = 1; part >= kMinTarget && sites.size() < std::min(fewest, most); part /= 2)
    sites = fitting::next_sites(body, computed, library, part * sampling.tolerance, most);
  return sites;
}

std::string distribution(const fidelity::ErrorRow& row) {
  return fmt::format("median {:.6g}, p95 {:.6g}, worst {:.6g}", row.median, row.p95, row.worst);
}

std::vector<std::pair<std::string, std::string>> facts_of(const SamplingRound& last,
                                                          SamplingEnd end,
                                                          const SamplingSection& sampling) {
  return {{"sampling", "adaptive"},
          {"sampling_rounds", std::to_string(last.number)},
          {"sites_computed", fmt::format("{} of {}", last.sites, last.of_sites)},
          {"hold_out_points", std::to_string(sampling.hold_out_points)},
          {"hold_out_points_failed", std::to_string(last.points_failed)},
          {"hold_out_states", std::to_string(last.along.states)},
          {"hold_out_tolerance", fmt::format("{:.6g}", sampling.tolerance)},
          {"hold_out_error_along_press", distribution(last.along)},
          {"hold_out_error_of_vector", distribution(last.whole)},
          {"sampling_ended", words(end)}};
}

/// Whether doubling the sites has reduced the error by less than a tenth.
bool no_longer_helps(const std::vector<SamplingRound>& rounds) {
  const SamplingRound& last = rounds.back();
  for (const SamplingRound& before : rounds)
    if (last.sites >= 2 * before.sites && last.along.p95 > 0.9 * before.along.p95) return true;
  return false;
}

/// Reason to stop, if any.
std::optional<SamplingEnd> end_of(const std::vector<SamplingRound>& rounds,
                                  const std::vector<std::int32_t>& more,
                                  const SamplingSection& sampling) {
  const SamplingRound& last = rounds.back();
  if (last.along.states > 0 && last.along.p95 <= sampling.tolerance)
    return SamplingEnd::ToleranceMet;
  if (last.sites == last.of_sites) return SamplingEnd::AllSites;
  if (last.sites >= static_cast<std::size_t>(sampling.max_sites)) return SamplingEnd::MostSites;
  if (more.empty() || no_longer_helps(rounds)) return SamplingEnd::NoLongerHelps;
  return std::nullopt;
}

}  // namespace

std::string words(SamplingEnd end) {
  switch (end) {
    case SamplingEnd::ToleranceMet:
      return "the error at the hold-out points is within the tolerance";
    case SamplingEnd::NoLongerHelps:
      return "more sites do not reduce the error; smaller elements or patches may";
    case SamplingEnd::AllSites:
      return "all sites are computed; a smaller mesh.patch_spacing gives more";
    case SamplingEnd::MostSites:
      return "sampling.max_sites is reached";
  }
  return {};
}

AdaptiveCampaign sample_adaptively(const Workspace& space, const Body& body,
                                   fem::CampaignSettings settings, const std::string& key,
                                   fem::CampaignCache& cache,
                                   const std::function<void(const SamplingRound&)>& tell) {
  const SamplingSection& sampling = space.c.sampling;
  const std::size_t of_sites = sites_of(body).size();
  KnownSites known(settings.known);
  AdaptiveCampaign result;
  std::optional<HoldOut> hold_out;
  std::vector<SamplingRound> rounds;
  settings.sites = fitting::spread_sites(body, sampling.initial_spacing);
  const auto start = std::chrono::steady_clock::now();
  for (bool open = true; open;) {
    settings.known = known.among(settings.sites);
    result.report = {};
    result.curves = fem::run_campaign(body, settings, result.report, &cache);
    known.add(result.curves.sites);
    const Library library = fitting::fit(body, result.curves, fit_settings(space));
    if (!hold_out) hold_out.emplace(space, body, library, cache, settings, key);
    rounds.push_back({static_cast<int>(rounds.size()) + 1,
                      settings.sites.size(),
                      of_sites,
                      p95_of(fitting::leave_one_out(library)),
                      {},
                      {},
                      0});
    hold_out->evaluate(library, result.curves, rounds.back());
    tell(rounds.back());
    const auto more = sites_to_add(space, body, settings.sites, library);
    const auto end = end_of(rounds, more, sampling);
    open = !end;
    if (end) result.end = *end;
    settings.sites.insert(settings.sites.end(), more.begin(), more.end());
    std::sort(settings.sites.begin(), settings.sites.end());
  }
  result.report.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.report.cpu_seconds += hold_out->report().cpu_seconds;
  result.facts = facts_of(rounds.back(), result.end, sampling);
  return result;
}

void remove_hold_out(const Workspace& space) {
  std::error_code none;
  fs::remove(hold_out_journal(space), none);
}

}  // namespace palpate::app
