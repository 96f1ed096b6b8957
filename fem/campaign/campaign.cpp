// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/campaign.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <numeric>
#include <optional>

#include "fem/campaign/indentation.hpp"
#include "fem/campaign/parallel_sites.hpp"
#include "fem/campaign/region_laws.hpp"
#include "fem/campaign/site_fields.hpp"
#include "fem/factor/cholesky.hpp"
#include "fem/mesh/to_eigen.hpp"
#include "fem/solid/pressure_smoothness.hpp"
#include "format/error.hpp"
#include "format/sha256.hpp"
#include "format/site_record.hpp"
#include "format/skin_mesh.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

std::vector<std::int32_t> chosen_sites(const Body& body, std::vector<std::int32_t> sites) {
  const auto& surface = body.response;
  const auto count = static_cast<std::int32_t>(surface.node.size());
  if (sites.empty())
    for (std::int32_t v = 0; v < count; ++v)
      if (surface.is_site[to_index(v)]) sites.push_back(v);
  std::sort(sites.begin(), sites.end());
  sites.erase(std::unique(sites.begin(), sites.end()), sites.end());
  for (const auto v : sites)
    if (v < 0 || v >= count || !surface.is_site[to_index(v)])
      throw Error(ErrorKind::Configuration, body.name,
                  "response vertex " + std::to_string(v) + " is not a site",
                  "choose vertices outside the supports, from 0 to " + std::to_string(count - 1));
  if (sites.empty())
    throw Error(ErrorKind::Configuration, body.name, "the body has no site to press",
                "shrink the supports so that some response vertices stay free");
  return sites;
}

/// The numbers of the results: the chosen response vertices, or the indices of the points.
std::vector<std::int32_t> numbers_of_results(const Body& body, const CampaignSettings& settings) {
  require_inside(body, "finite elements");
  if (settings.points.empty()) return chosen_sites(body, settings.sites);
  std::vector<std::int32_t> index(settings.points.size());
  std::iota(index.begin(), index.end(), 0);
  for (const PressPoint& point : settings.points)
    if (!(std::abs(norm(point.inward) - 1) < 1e-6))
      throw Error(ErrorKind::Configuration, body.name,
                  "a point to press has a direction that is not of unit length",
                  "give unit directions into the body");
  return index;
}

/// Copies known results. @return the indices of the sites that remain to be solved.
std::vector<std::size_t> copy_known(const std::vector<SiteCurves>& known, Curves& curves) {
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < curves.sites.size(); ++i) {
    const auto same = [&](const SiteCurves& site) { return site.vertex == curves.sites[i].vertex; };
    const auto found = std::find_if(known.begin(), known.end(), same);
    if (found == known.end())
      open.push_back(i);
    else
      curves.sites[i] = *found;
  }
  return open;
}

/// Solves the open sites and reports each as it finishes.
class OpenSites {
 public:
  /// `open`: the indices of the sites of `curves` to be solved.
  OpenSites(const CampaignContext& context, const CampaignSettings& settings,
            const std::vector<std::size_t>& open, Curves& curves)
      : context_(context), settings_(settings), open_(spread_out(open)), curves_(curves) {
    if (keeps_fields()) skin_ = skin_mesh(context.body);
    progress_.total = static_cast<std::int64_t>(curves.sites.size());
    progress_.done = progress_.total - static_cast<std::int64_t>(open_.size());
    progress_.known = progress_.done;
    for (const SiteCurves& site : settings.known)
      if (site.status != SiteStatus::Complete) ++progress_.failed;
  }

  void run() {
    if (settings_.progress) settings_.progress(progress_);
    const SiteThreads size =
        site_threads(*context_.rest_factor, settings_.threads, open_.size(), settings_.memory,
                     bytes_of_site(context_, curves_.sites[open_.front()].vertex),
                     sites_for_each_core(context_.indentation, context_.model.pattern().n));
    parallel_for_sites(*context_.rest_factor, size, open_.size(),
                       [this](SolvePool::Member& member, std::size_t i) {
                         solve(member, curves_.sites[open_[i]]);
                       });
  }

 private:
  void solve(SolvePool::Member& member, SiteCurves& result) {
    {
      const std::lock_guard lock(mutex_);
      ++progress_.running;
      progress_.sites.push_back({result.vertex, 0, 0});
      if (settings_.advanced) settings_.advanced(progress_);
    }
    SiteSolver solver(context_, &member);
    solver.on_increment([&](double fraction, double seconds) {
      advance({result.vertex, fraction, seconds});
    });
    std::optional<FieldRecorder> recorder;
    if (keeps_fields()) {
      recorder.emplace(solver, context_, skin_.node, settings_.field_depths,
                       settings_.field_friction);
      solver.also_across(context_.indentation.azimuths.size() == 1);
    }
    SiteCurves site = solver.solve(result.vertex);
    const std::lock_guard lock(mutex_);
    if (recorder) give_fields(*recorder, site);
    --progress_.running;
    progress_.sites.erase(running_site(result.vertex));
    ++progress_.done;
    if (site.status != SiteStatus::Complete) ++progress_.failed;
    result = std::move(site);
    if (settings_.finished) settings_.finished(result);
    if (settings_.progress) settings_.progress(progress_);
  }

  std::vector<SiteProgress>::iterator running_site(std::int32_t vertex) {
    return std::find_if(progress_.sites.begin(), progress_.sites.end(),
                        [&](const SiteProgress& site) { return site.vertex == vertex; });
  }

  void advance(const SiteProgress& site) {
    const std::lock_guard lock(mutex_);
    *running_site(site.vertex) = site;
    if (settings_.advanced) settings_.advanced(progress_);
  }

  bool keeps_fields() const { return static_cast<bool>(settings_.fields); }
  void give_fields(FieldRecorder& recorder, const SiteCurves& site) {
    SiteFields fields = recorder.take(site.vertex);
    fields.curves = sha256(site_bytes(site));
    settings_.fields(std::move(fields));
  }

  const CampaignContext& context_;
  const CampaignSettings& settings_;
  SkinMesh skin_;
  std::vector<std::size_t> open_;
  Curves& curves_;
  std::mutex mutex_;
  CampaignProgress progress_;
};

/// Facts about the foundation and the weight of the body.
void add_supports(const CampaignContext& context, const CampaignSettings& settings,
                  CampaignReport& report) {
  if (const auto& foundation = context.body.foundation; !foundation.empty())
    report.facts.emplace_back("facets_on_springs", std::to_string(foundation.size()));
  if (!settings.gravity.acts()) return;
  const double largest = context.rest.colwise().norm().maxCoeff();
  report.facts.emplace_back("max_gravity_displacement_m", std::to_string(largest));
  report.facts.emplace_back("min_jacobian_before_touch", std::to_string(context.at_rest.min_J));
  if (!context.unloaded) return;
  char distance[32];
  std::snprintf(distance, sizeof distance, "%.2g", context.unloaded->distance);
  report.facts.emplace_back("given_shape", "loaded");
  report.facts.emplace_back("unloaded_shape_distance_m", distance);
  report.facts.emplace_back("unloaded_shape_equilibria",
                            std::to_string(context.unloaded->iterations));
}

}  // namespace

Curves run_campaign(const Body& body, const CampaignSettings& settings, CampaignReport& report,
                    CampaignCache* cache) {
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  check_indentation(settings.indentation);
  Curves curves;
  curves.tool = description_of(settings.indentation);
  curves.depth = settings.indentation.depth;
  curves.lateral_travel = settings.indentation.lateral_travel;
  for (const auto vertex : numbers_of_results(body, settings)) {
    curves.sites.emplace_back();
    curves.sites.back().vertex = vertex;
  }
  const std::vector<std::size_t> open = copy_known(settings.known, curves);
  const CampaignContext context(body, settings, Engine::SharedFactor, cache);
  curves.relaxation = context.relaxation;
  report.unknowns = context.model.pattern().n;
  report.set_up_seconds = elapsed();
  if (!open.empty()) OpenSites(context, settings, open, curves).run();

  report.seconds = elapsed();
  for (const auto& site : curves.sites) report.cpu_seconds += site.cpu_seconds;
  report.facts = {
      {"element", name_of(settings.dilatation)},
      {"nodes", std::to_string(context.model.mesh().nodes())},
      {"unknowns", std::to_string(report.unknowns)},
      {"rest_factor_bytes", std::to_string(static_cast<long long>(context.rest_factor->bytes()))},
      {"blas_kernel", blas_kernel()},
      {"solver", solver_versions()}};
  if (settings.indentation.refine_under_tool == IndentationSettings::kByContact)
    report.facts.emplace_back("under_the_tool", "elements divided as the contact asks for");
  if (const int times = settings.indentation.refine_under_tool; times > 0)
    report.facts.emplace_back(
        "under_the_tool",
        "elements divided into eight" + (times > 1 ? ", " + std::to_string(times) + " times" : ""));
  add_supports(context, settings, report);
  return curves;
}

DeformedState deformed_state(const Body& body, const CampaignSettings& settings,
                             std::int32_t vertex) {
  check_indentation(settings.indentation);
  chosen_sites(body, {vertex});
  CampaignSettings normal_only = settings;
  normal_only.indentation.lateral_depths.clear();
  const CampaignContext context(body, normal_only, Engine::SharedFactor);
  Displacement u, rest;
  const SiteCurves curves = solve_site(context, vertex, &u, &rest);
  DeformedState state;
  for (std::size_t i = 0; i < body.nodes.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    Eigen::Vector3d moved = u.col(column);
    if (context.unloaded) moved -= rest.col(column);
    state.displacement.push_back(to_vec3(moved));
  }
  context.model.element_fields(u, state.strain_energy_density, state.pressure);
  SmoothPressure smooth = smooth_pressure(context.model.mesh(), state.pressure);
  state.smooth_pressure = std::move(smooth.pressure);
  state.pressure_alternation = smooth.alternation;
  state.sample = curves.paths.front().samples.back();
  return state;
}

}  // namespace palpate::fem
