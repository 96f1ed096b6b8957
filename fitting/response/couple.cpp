// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/response/couple.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/response/site_samples.hpp"
#include "fitting/response/soft_axis.hpp"
#include "runtime/response_curve.hpp"

namespace palpate::fitting {
namespace {

constexpr double kMinDepthFraction = 0.05;  // of the depth: below it w is constant
constexpr int kCouplingSamples = 16;
constexpr double kCouplingTolerance = 0.01;  // of the local w: tolerance of its fit
constexpr int kAlternations = 3;  // of f^r and w; the product of two factors converges at once
constexpr float kBeyond = 1.25F;  // of the depth: beyond it w is constant
constexpr float kLevel = 0.05F;   // of the largest slope of w: treated as constant

/// The lateral paths at one depth, all azimuths.
struct Level {
  double depth = 0;
  double weight = 1;  ///< w at this depth
  std::vector<SoftDrag> paths;
};

std::vector<Level> levels_of(const SiteCurves& site, const Vec3& soft_axis) {
  std::vector<Level> levels;
  for (const double depth : lateral_depths(site)) {
    Level level{depth, 1, soft_drags(paths_at(site, depth), soft_axis)};
    if (!level.paths.empty()) levels.push_back(std::move(level));
  }
  return levels;
}

/// The w of a level that brings w f^r closest to its samples, by least squares.
double weight_of(const Level& level, const runtime::CompiledCurve& lateral) {
  double above = 0, below = 0;
  for (const auto& path : along_stiffest(level.paths, lateral)) {
    for (const ForceSample& sample : with_forces_between(path)) {
      const double f = lateral.force(sample.displacement);
      above += f * sample.force;
      below += f * f;
    }
  }
  // Without a positive projection there is no coupling.
  return below > 0 && above > 0 ? above / below : 1;
}

ResponseCurve pooled_lateral(const std::vector<Level>& levels,
                             const runtime::CompiledCurve& lateral,
                             const CurveFitSettings& settings, const std::string& where) {
  std::vector<std::vector<ForceSample>> scaled;
  for (const Level& level : levels) {
    for (auto path : along_stiffest(level.paths, lateral)) {
      for (ForceSample& sample : path) {
        sample.force /= level.weight;
        sample.mean /= level.weight;
      }
      scaled.push_back(std::move(path));
    }
  }
  return fit_curve(mean_lateral(scaled), settings, where + ", lateral response").curve;
}

/// Linear in the logarithms between the depths, proportional to sqrt(z) outside.
double weight_at(const std::vector<Level>& levels, double z) {
  const auto root = [&](const Level& from) { return from.weight * std::sqrt(z / from.depth); };
  if (z <= levels.front().depth) return root(levels.front());
  for (std::size_t j = 1; j < levels.size(); ++j) {
    const Level& low = levels[j - 1];
    const Level& high = levels[j];
    if (z > high.depth) continue;
    const double t = std::log(z / low.depth) / std::log(high.depth / low.depth);
    return std::exp((1 - t) * std::log(low.weight) + t * std::log(high.weight));
  }
  return root(levels.back());
}

CouplingCurve fitted_coupling(const std::vector<Level>& levels, double depth, int max_knots,
                              const std::string& where) {
  CouplingCurve coupling;
  const double first = kMinDepthFraction * depth;
  coupling.base = static_cast<float>(weight_at(levels, first));
  std::vector<ForceSample> samples;
  for (int i = 1; i <= kCouplingSamples; ++i) {
    const double z = first * std::pow(depth / first, static_cast<double>(i) / kCouplingSamples);
    samples.push_back({z, weight_at(levels, z) - static_cast<double>(coupling.base)});
  }
  const double tolerance = kCouplingTolerance * weight_at(levels, 0.5 * depth);
  coupling.curve =
      fit_curve(samples, {1e-6, tolerance, max_knots, true}, where + ", coupling").curve;
  level_off(coupling);
  return coupling;
}

}  // namespace

void level_off(CouplingCurve& coupling) {
  std::vector<float>&knot = coupling.curve.knot, &slope = coupling.curve.slope;
  const float steepest = *std::max_element(slope.begin(), slope.end());
  if (slope.back() > kLevel * steepest) {
    knot.push_back(kBeyond * knot.back());
    slope.push_back(0);
  }
  slope.back() = 0;
}

CoupledLateral fit_coupled(const SiteCurves& site, const Vec3& soft_axis, double depth,
                           const CurveFitSettings& settings, const std::string& where) {
  std::vector<Level> levels = levels_of(at_every_depth(site), soft_axis);
  const Level& middle = levels[levels.size() / 2];
  CoupledLateral result;
  result.lateral = fit_curve(mean_lateral(along_stiffest(middle.paths, {})), settings, where).curve;
  for (int i = 0; i < kAlternations; ++i) {
    const runtime::CompiledCurve lateral(result.lateral);
    for (Level& level : levels) level.weight = weight_of(level, lateral);
    const double unit = middle.weight;
    for (Level& level : levels) level.weight /= unit;
    result.lateral = pooled_lateral(levels, lateral, settings, where);
  }
  result.coupling = fitted_coupling(levels, depth, settings.max_knots, where);
  return result;
}

}  // namespace palpate::fitting
