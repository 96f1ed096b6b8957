// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/fill.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "fitting/curve_fit.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {
namespace {

using CurveList = std::vector<runtime::CompiledCurve>;

std::vector<std::set<std::size_t>> neighbours_of(const Library& library) {
  std::vector<std::set<std::size_t>> neighbours(library.positions.size());
  for (const Triangle& triangle : library.triangles) {
    for (const std::int32_t a : triangle) {
      for (const std::int32_t b : triangle) {
        if (a != b) neighbours[static_cast<std::size_t>(a)].insert(static_cast<std::size_t>(b));
      }
    }
  }
  return neighbours;
}

double mean_force(const CurveList& curves, double d) {
  double sum = 0;
  for (const runtime::CompiledCurve& curve : curves) sum += curve.force(d);
  return sum / static_cast<double>(curves.size());
}

/// Samples of the mean, several in each piece of each curve, so that the fit sees all of it.
std::vector<ForceSample> mean_samples(const CurveList& curves) {
  constexpr int kPerPiece = 4;
  std::set<double> displacements;
  for (const runtime::CompiledCurve& curve : curves) {
    const auto& pieces = curve.pieces();
    for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
      const double low = pieces[k].start;
      const double high = pieces[k + 1].start;
      for (int i = 1; i <= kPerPiece; ++i) {
        displacements.insert(low + (high - low) * i / kPerPiece);
      }
    }
  }
  std::vector<ForceSample> samples;
  samples.reserve(displacements.size());
  for (const double d : displacements) samples.push_back({d, mean_force(curves, d)});
  return samples;
}

double largest_difference(const ResponseCurve& filled, const CurveList& curves) {
  const runtime::CompiledCurve rendered(filled);
  double largest = 0;
  for (const ForceSample& sample : mean_samples(curves)) {
    const double force = rendered.force(sample.displacement);
    for (const runtime::CompiledCurve& curve : curves) {
      largest = std::max(largest, std::abs(force - curve.force(sample.displacement)));
    }
  }
  return largest;
}

CouplingCurve mean_coupling(const std::vector<const NodeResponse*>& sources,
                            CurveFitSettings settings, const std::string& where) {
  CouplingCurve mean;
  CurveList curves;
  double base = 0;
  for (const NodeResponse* source : sources) {
    curves.emplace_back(source->coupling.curve);
    base += static_cast<double>(source->coupling.base) / static_cast<double>(sources.size());
  }
  mean.base = static_cast<float>(base);
  settings.zero_first_slope = true;
  settings.absolute_tolerance = settings.relative_tolerance;  // of w, which is about 1
  mean.curve = fit_curve(mean_samples(curves), settings, where).curve;
  return mean;
}

NodeResponse mean_response(const std::vector<const NodeResponse*>& sources,
                           const FitSettings& settings, const std::string& where) {
  CurveList normal;
  CurveList lateral;
  for (const NodeResponse* source : sources) {
    normal.emplace_back(source->normal);
    lateral.emplace_back(source->lateral);
  }
  CurveFitSettings curve{settings.relative_tolerance, settings.absolute_tolerance,
                         settings.max_knots, true};
  NodeResponse response;
  response.status = ResponseStatus::Filled;
  response.normal = fit_curve(mean_samples(normal), curve, where).curve;
  curve.zero_first_slope = false;
  response.lateral = fit_curve(mean_samples(lateral), curve, where).curve;
  if (settings.kind == ResponseKind::Coupled)
    response.coupling = mean_coupling(sources, curve, where);
  response.normal_error = largest_difference(response.normal, normal);
  response.lateral_error = largest_difference(response.lateral, lateral);
  return response;
}

}  // namespace

void fill_holes(Library& library, const FitSettings& settings) {
  const auto neighbours = neighbours_of(library);
  for (bool progress = true; progress;) {
    progress = false;
    // One ring at a time, from the state before the ring: the order of vertices must not matter.
    const std::vector<NodeResponse> before = library.responses;
    for (std::size_t v = 0; v < before.size(); ++v) {
      if (before[v].status != ResponseStatus::Hole) continue;
      std::vector<const NodeResponse*> sources;
      for (const std::size_t n : neighbours[v]) {
        if (before[n].status != ResponseStatus::Hole) sources.push_back(&before[n]);
      }
      if (sources.empty()) continue;
      library.responses[v] =
          mean_response(sources, settings, "filled response of vertex " + std::to_string(v));
      progress = true;
    }
  }
}

}  // namespace palpate::fitting
