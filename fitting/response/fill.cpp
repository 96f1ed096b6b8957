// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/fill.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "fitting/response/mean_response.hpp"
#include "fitting/response/neighbours.hpp"

namespace palpate::fitting {
namespace {

NodeResponse mean_of_neighbours(const std::vector<const NodeResponse*>& neighbours,
                                const FitSettings& settings, const std::string& where) {
  std::vector<WeightedResponse> sources;
  for (const NodeResponse* neighbour : neighbours)
    sources.push_back({neighbour, 1 / static_cast<double>(neighbours.size())});
  NodeResponse mean = mean_response(sources, settings, where);
  for (const NodeResponse* neighbour : neighbours) {
    const ResponseDifference difference = largest_difference(mean, *neighbour);
    mean.normal_error = std::max(mean.normal_error, difference.normal);
    mean.lateral_error = std::max(mean.lateral_error, difference.lateral);
  }
  return mean;
}

}  // namespace

void fill_holes(Library& library, const FitSettings& settings) {
  const auto neighbours = neighbours_of(library);
  for (bool progress = true; progress;) {
    progress = false;
    // Each ring is filled from the state before it, so the order of vertices does not matter.
    const std::vector<NodeResponse> before = library.responses;
    for (std::size_t v = 0; v < before.size(); ++v) {
      if (before[v].status != ResponseStatus::Hole) continue;
      std::vector<const NodeResponse*> sources;
      for (const std::size_t n : neighbours[v]) {
        if (before[n].status != ResponseStatus::Hole) sources.push_back(&before[n]);
      }
      if (sources.empty()) continue;
      library.responses[v] = mean_of_neighbours(
          sources, settings, "interpolated response of vertex " + std::to_string(v));
      progress = true;
    }
  }
}

}  // namespace palpate::fitting
