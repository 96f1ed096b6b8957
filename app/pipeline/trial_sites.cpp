// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/pipeline/trial_sites.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "app/pipeline/campaign_sites.hpp"
#include "app/pipeline/settings.hpp"
#include "fem/campaign/finer_mesh.hpp"
#include "fem/campaign/parallel_sites.hpp"
#include "fem/factor/memory.hpp"
#include "format/to_index.hpp"
#include "mesher/geometry/thickness.hpp"

namespace palpate::app {
namespace {

constexpr std::size_t kTrialsPerThread = 6;
/// Time of a site on a finer mesh over that of others (`bench_mesh_error bound`).
constexpr double kFinerOverOthers = 6;

/// Ends a trial whose patience is over.
struct OutOfPatience {};

/// How many sites take as long as those of the shard that are pressed on a finer mesh.
double sites_worth_of_finer_mesh(const Workspace& space, const Body& body,
                                 const fem::CampaignSettings& settings) {
  const std::size_t sites = fem::sites_on_finer_mesh(body, settings, sites_of(body)).size();
  return kFinerOverOthers * static_cast<double>(sites) / space.shard.count;
}

/// The boundary of the body with the response vertices as its first points.
mesher::Surface surface_from_vertices(const Body& body) {
  mesher::Surface surface;
  std::vector<std::int32_t> index(body.nodes.size(), -1);
  const auto index_of = [&](std::int32_t node) {
    std::int32_t& known = index[to_index(node)];
    if (known < 0) {
      known = static_cast<std::int32_t>(surface.points.size());
      surface.points.push_back(body.nodes[to_index(node)]);
    }
    return known;
  };
  for (const std::int32_t node : body.response.node) index_of(node);
  for (const Triangle& facet : body.boundary)
    surface.triangles.push_back({index_of(facet[0]), index_of(facet[1]), index_of(facet[2])});
  return surface;
}

}  // namespace

std::vector<std::int32_t> by_thickness(const Body& body, std::vector<std::int32_t> sites,
                                       double tool_radius) {
  const std::vector<double> thickness =
      mesher::thickness_under_tool(surface_from_vertices(body), body.response.inward, tool_radius);
  std::stable_sort(sites.begin(), sites.end(), [&](std::int32_t a, std::int32_t b) {
    return thickness[to_index(a)] < thickness[to_index(b)];
  });
  return sites;
}

std::vector<std::int32_t> spread(const std::vector<std::int32_t>& sites, std::size_t count) {
  if (count >= sites.size()) return sites;
  std::vector<std::int32_t> some;
  for (std::size_t i = 0; i < count; ++i)
    some.push_back(sites[(2 * i + 1) * sites.size() / (2 * count)]);
  return some;
}

Trial press_trial_sites(const Workspace& space, const Body& body, double patience) {
  fem::CampaignSettings settings = campaign_settings(space);
  Trial trial;
  trial.time = RemainingTime(sharing_of(settings));
  settings.sites = spread(
      by_thickness(body, sites_of_shard(body, space.shard), settings.indentation.tool.radius),
      kTrialsPerThread * static_cast<std::size_t>(space.threads));
  trial.sites = settings.sites.size();
  trial.on_finer_mesh = sites_worth_of_finer_mesh(space, body, settings);
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [start] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  double first = 0;
  const auto update = [&](const fem::CampaignProgress& p) {
    const double now = elapsed();
    trial.pressed = now - first;
    trial.time.update(now, p.done, p.total, p.sites);
    if (trial.pressed > patience && p.done < p.total) throw OutOfPatience{};
  };
  settings.advanced = update;
  settings.progress = [&](const fem::CampaignProgress& p) {
    const double bytes = fem::resident_bytes();
    trial.bytes_between = std::max(trial.bytes_between, bytes);
    if (p.done > 0) return update(p);
    trial.bytes_before = bytes;
    first = elapsed();
    trial.time.begin(first);
  };
  try {
    trial.curves = fem::run_campaign(body, settings, trial.report);
  } catch (const OutOfPatience&) {
    trial.curves = {};
  }
  return trial;
}

std::size_t concurrent_sites(const Workspace& space, const Trial& trial, std::size_t all) {
  const auto threads = static_cast<std::size_t>(space.threads);
  const auto most = static_cast<std::size_t>(fem::sites_for_each_core(
      space.c.campaign.indentation, static_cast<int>(trial.report.unknowns)));
  return threads * std::min(most, (all + threads - 1) / threads);
}

/// Where no increment has ended, the sites take at least as long as they were waited for.
double campaign_seconds(const Workspace& space, const Trial& trial, std::size_t sites) {
  const auto all = sites + static_cast<std::size_t>(std::lround(trial.on_finer_mesh));
  const double foretold =
      trial.time.campaign(static_cast<std::int64_t>(all),
                          static_cast<std::int64_t>(concurrent_sites(space, trial, all)));
  const double least = trial.pressed * static_cast<double>(all) /
                       static_cast<double>(std::max<std::size_t>(1, trial.sites));
  return trial.report.set_up_seconds + (foretold > 0 ? foretold : least);
}

}  // namespace palpate::app
