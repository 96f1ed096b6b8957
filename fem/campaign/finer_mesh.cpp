// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/finer_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

/// Largest h'/h of a mesh that counts as finer.
constexpr double kFiner = 0.85;

const Vec3& position_of(const Body& body, std::int32_t vertex) {
  return body.nodes[to_index(body.response.node[to_index(vertex)])];
}

bool same(double a, double b) {
  return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b));
}

/// h'/h of the facets in contact; 0 where the contact is too small to be felt by the mesh.
double size_ratio(const CurveSample& finer, const CurveSample& sample) {
  return std::sqrt(sample.facets_in_contact / finer.facets_in_contact);
}

void take_differences(const CurvePath& finer, CurvePath& path) {
  for (std::size_t i = 1; i < path.samples.size(); ++i) {
    CurveSample& sample = path.samples[i];
    const auto there = std::find_if(
        finer.samples.begin() + 1, finer.samples.end(),
        [&](const CurveSample& other) { return same(other.displacement, sample.displacement); });
    if (there == finer.samples.end()) continue;
    const double ratio = size_ratio(*there, sample);
    if (!(ratio <= kFiner)) continue;
    sample.mesh_difference =
        (response_force(finer, *there) - response_force(path, sample)) / (1 - ratio);
  }
}

CampaignSettings finer_settings(const CampaignSettings& settings, std::vector<std::int32_t> sites) {
  CampaignSettings finer = settings;
  finer.indentation.divide_once_more = true;
  finer.indentation.azimuths.clear();  // the normal path alone, through the lateral depths
  finer.sites = std::move(sites);
  finer.known.clear();
  finer.finished = nullptr;
  finer.fields = nullptr;
  finer.progress = nullptr;
  finer.advanced = nullptr;
  return finer;
}

}  // namespace

std::vector<std::int32_t> sites_far_apart(const Body& body, const std::vector<std::int32_t>& sites,
                                          int count) {
  std::vector<std::int32_t> chosen;
  std::vector<double> distance(sites.size(), std::numeric_limits<double>::infinity());
  while (chosen.size() < std::min(to_index(count), sites.size())) {
    const auto next =
        chosen.empty() ? distance.begin() : std::max_element(distance.begin(), distance.end());
    chosen.push_back(sites[static_cast<std::size_t>(next - distance.begin())]);
    for (std::size_t i = 0; i < sites.size(); ++i)
      distance[i] = std::min(distance[i],
                             norm(position_of(body, sites[i]) - position_of(body, chosen.back())));
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

void press_on_finer_mesh(const Body& body, const CampaignSettings& settings,
                         const std::vector<std::int32_t>& chosen, Curves& curves,
                         CampaignReport& report, FactorCache* cache) {
  std::vector<std::int32_t> here;
  for (const SiteCurves& site : curves.sites)
    if (site.status != SiteStatus::Failed &&
        std::find(chosen.begin(), chosen.end(), site.vertex) != chosen.end())
      here.push_back(site.vertex);
  if (here.empty()) return;
  const Curves finer = run_campaign(body, finer_settings(settings, here), report, cache);
  for (const SiteCurves& again : finer.sites) {
    const auto site = std::find_if(curves.sites.begin(), curves.sites.end(),
                                   [&](const SiteCurves& s) { return s.vertex == again.vertex; });
    take_differences(again.paths.front(), site->paths.front());
  }
}

}  // namespace palpate::fem
