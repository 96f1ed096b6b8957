// SPDX-License-Identifier: AGPL-3.0-or-later
// A response made of others: where none was computed.
#pragma once

#include <string>
#include <vector>

#include "fitting/response/fit_settings.hpp"

namespace palpate::fitting {

struct WeightedResponse {
  const NodeResponse* response = nullptr;
  double weight = 0;
};

/// The weighted mean of the responses at equal deflections, fitted like any curve (hence monotone
/// and passive whatever the weights) and marked Filled. Weights sum to 1; single ones may be
/// negative. The errors are left at 0 for the caller to state.
NodeResponse mean_response(const std::vector<WeightedResponse>& sources,
                           const FitSettings& settings, const std::string& where);

/// Largest difference of the two over the deflections up to their last knots, N, of the normal and
/// of the lateral response.
struct ResponseDifference {
  double normal = 0, lateral = 0;
};
ResponseDifference largest_difference(const NodeResponse& a, const NodeResponse& b);

}  // namespace palpate::fitting
