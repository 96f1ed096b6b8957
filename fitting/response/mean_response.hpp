// SPDX-License-Identifier: AGPL-3.0-or-later
// Weighted means of responses.
#pragma once

#include <string>
#include <vector>

#include "fitting/response/fit_settings.hpp"

namespace palpate::fitting {

struct WeightedResponse {
  const NodeResponse* response = nullptr;
  double weight = 0;
};

/// Weighted mean of the responses at equal deflections, with status Interpolated. It is fitted like
/// any curve, hence monotone and passive for any weights. The weights sum to 1 and may be negative.
/// The errors of the fit are 0; the caller sets them. That of the mesh is the largest of the
/// sources.
NodeResponse mean_response(const std::vector<WeightedResponse>& sources,
                           const FitSettings& settings, const std::string& where);

/// Largest differences over the deflections up to the last knots, N.
struct ResponseDifference {
  double normal = 0, lateral = 0;
};
ResponseDifference largest_difference(const NodeResponse& a, const NodeResponse& b);

}  // namespace palpate::fitting
