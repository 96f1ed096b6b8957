// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/campaign/finer_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "fem/campaign/campaign_context.hpp"
#include "fem/mesh/sharp_edges.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

/// Largest h'/h of a mesh that counts as finer.
constexpr double kFiner = 0.85;
/// The power of h with which the error decreases: the first where the contact covers a facet or
/// less, more where it divides the elements (`bench_mesh_error bound`).
constexpr double kOrder = 1, kOrderByContact = 1.5;
/// Cosine between the directions of a path on both meshes.
constexpr double kSameDirection = 1 - 1e-9;

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

/// The same path on the finer mesh; null where there is none.
const CurvePath* counterpart(const SiteCurves& finer, const CurvePath& path) {
  const auto found = std::ranges::find_if(finer.paths, [&](const CurvePath& other) {
    return other.kind == path.kind && same(other.lateral_depth, path.lateral_depth) &&
           dot(other.direction, path.direction) > kSameDirection;
  });
  return found == finer.paths.end() ? nullptr : &*found;
}

void take_differences(const CurvePath& finer, double order, CurvePath& path) {
  for (std::size_t i = 1; i < path.samples.size(); ++i) {
    CurveSample& sample = path.samples[i];
    const auto there = std::find_if(
        finer.samples.begin() + 1, finer.samples.end(),
        [&](const CurveSample& other) { return same(other.displacement, sample.displacement); });
    if (there == finer.samples.end()) continue;
    const double ratio = size_ratio(*there, sample);
    if (!(ratio <= kFiner)) continue;
    sample.mesh_difference = (response_force(finer, *there) - response_force(path, sample)) /
                             (1 - std::pow(ratio, order));
  }
}

CampaignSettings finer_settings(const CampaignSettings& settings, std::vector<std::int32_t> sites) {
  CampaignSettings finer = settings;
  finer.indentation.divide_once_more = true;
  finer.sites = std::move(sites);
  finer.known.clear();
  finer.finished = nullptr;
  finer.fields = nullptr;
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

std::vector<bool> at_sharp_edges(const Body& body, const ToolDescription& tool, double depth) {
  const bool sphere = tool.shape == name_of(ToolShape::Sphere);
  const double reach = sphere ? std::min(tool.radius, std::sqrt(2 * tool.radius * depth))
                              : tool.radius + 0.5 * tool.length;
  return near_sharp_edges(body, reach);
}

std::vector<std::int32_t> sites_on_finer_mesh(const Body& body, const CampaignSettings& settings,
                                              const std::vector<std::int32_t>& sites) {
  if (settings.mesh_error_sites == 0 || !obstacle_to_refinement(settings).empty()) return {};
  const std::vector<bool> at_edge =
      at_sharp_edges(body, description_of(settings.indentation), settings.indentation.depth);
  std::vector<std::int32_t> chosen;
  for (const bool edge : {false, true}) {
    std::vector<std::int32_t> alike;
    std::copy_if(sites.begin(), sites.end(), std::back_inserter(alike),
                 [&](std::int32_t vertex) { return at_edge[to_index(vertex)] == edge; });
    const int few = std::max(3, static_cast<int>(alike.size() / 10));
    const auto some = sites_far_apart(body, alike, std::min(settings.mesh_error_sites, few));
    chosen.insert(chosen.end(), some.begin(), some.end());
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

void press_on_finer_mesh(const Body& body, const CampaignSettings& settings,
                         const std::vector<std::int32_t>& chosen, Curves& curves,
                         CampaignReport& report, CampaignCache* cache) {
  std::vector<std::int32_t> here;
  for (const SiteCurves& site : curves.sites)
    if (site.status != SiteStatus::Failed &&
        std::find(chosen.begin(), chosen.end(), site.vertex) != chosen.end())
      here.push_back(site.vertex);
  if (here.empty()) return;
  const Curves finer = run_campaign(body, finer_settings(settings, here), report, cache);
  const bool by_contact = settings.indentation.refine_under_tool == IndentationSettings::kByContact;
  for (const SiteCurves& again : finer.sites) {
    const auto site = std::find_if(curves.sites.begin(), curves.sites.end(),
                                   [&](const SiteCurves& s) { return s.vertex == again.vertex; });
    for (CurvePath& path : site->paths)
      if (const CurvePath* finer_path = counterpart(again, path))
        take_differences(*finer_path, by_contact ? kOrderByContact : kOrder, path);
  }
}

}  // namespace palpate::fem
