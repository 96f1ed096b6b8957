// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/fit_errors.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/response/site_samples.hpp"
#include "fitting/response/soft_axis.hpp"
#include "format/to_index.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {
namespace {

constexpr double kFeltFraction = 0.01;  // of the largest normal force

using Samples = std::vector<ForceSample>;

double peak(const Samples& samples) {
  double largest = 0;
  for (const ForceSample& sample : samples) largest = std::max(largest, std::abs(sample.force));
  return largest;
}

/// Largest |weight f - sample|.
double largest_miss(const runtime::CompiledCurve& curve, double weight, const Samples& samples) {
  double largest = 0;
  for (const ForceSample& sample : samples)
    largest = std::max(largest, std::abs(weight * curve.force(sample.displacement) - sample.force));
  return largest;
}

/// Largest miss of the means that the lateral response stands for, N.
double lateral_miss(const NodeResponse& node, ResponseKind kind, const SiteCurves& whole) {
  const SiteCurves site = at_every_depth(whole);
  const runtime::CompiledCurve lateral(node.lateral);
  if (kind == ResponseKind::Decoupled)
    return largest_miss(lateral, 1, mean_lateral(lateral_paths(site)));
  const runtime::CompiledCurve weight(node.coupling.curve, static_cast<double>(node.coupling.base));
  double largest = 0;
  for (const double depth : lateral_depths(site)) {
    const auto paths =
        along_stiffest(soft_drags(paths_at(site, depth), vec3_of(node.soft_axis)), lateral);
    if (!paths.empty())
      largest = std::max(largest, largest_miss(lateral, weight.force(depth), mean_lateral(paths)));
  }
  return largest;
}

double ratio(double error, double scale) {
  return scale > 0 ? error / scale : 0;
}

SiteFitError error_of(const NodeResponse& node, ResponseKind kind, const SiteCurves& site) {
  const double normal_peak = peak(normal_samples(site));
  double lateral_peak = kFeltFraction * normal_peak;
  for (const Samples& path : lateral_paths(site)) lateral_peak = std::max(lateral_peak, peak(path));
  return {site.vertex,
          ratio(node.normal_error, normal_peak),
          ratio(lateral_miss(node, kind, site), lateral_peak),
          ratio(node.lateral_error, lateral_peak),
          ratio(node.normal_mesh_error, normal_peak),
          ratio(node.lateral_mesh_error, lateral_peak)};
}

}  // namespace

std::vector<SiteFitError> fit_errors(const Library& library, const Curves& curves) {
  std::vector<SiteFitError> errors;
  for (const SiteCurves& site : curves.sites) {
    const NodeResponse& node = library.responses[to_index(site.vertex)];
    if (node.status == ResponseStatus::Fitted) errors.push_back(error_of(node, library.kind, site));
  }
  return errors;
}

FitErrorSummary summary_of(const std::vector<SiteFitError>& errors, double SiteFitError::*which) {
  std::vector<double> values;
  FitErrorSummary summary{0, -1, -1};
  for (const SiteFitError& error : errors) {
    if (std::isnan(error.*which)) continue;
    values.push_back(error.*which);
    if (values.back() > summary.worst) {
      summary.worst = values.back();
      summary.vertex = error.vertex;
    }
  }
  if (values.empty()) return {};
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  summary.median = *middle;
  return summary;
}

}  // namespace palpate::fitting
